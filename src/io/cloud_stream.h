// Clouds one after another in a stream: those of formats whose header says where they end.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pointreel/io.h"

namespace pointreel::io {

struct LeadingCloud {
  CloudFormat format;  // pcd or ply
  std::size_t bytes;   // header and body
};

// The cloud at the front of `bytes`; none while its header is not whole (an empty string is no fault). The
// body need not be there yet. Errors: unsupported for what is neither binary PCD nor binary PLY, or has
// lists; corrupt; resource_limit.
Result<std::optional<LeadingCloud>> leading_cloud(std::string_view bytes, const std::string& stream);

}  // namespace pointreel::io
