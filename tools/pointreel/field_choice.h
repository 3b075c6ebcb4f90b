// --fields: which fields of the sweeps are kept, and how exactly.
#pragma once

#include <string>
#include <string_view>

#include "pointreel/codec.h"

namespace pointreel {

// "all", "none", or a list of NAME, NAME:STEP and all: "intensity,ring", "all,intensity:0.02".
Result<FieldSelection> parse_field_selection(std::string_view text);

// Error naming a chosen field that `cloud`, read from `file`, does not have.
Result<void> require_fields(const FieldSelection& selection, const PointCloud& cloud,
                            const std::string& file);

// "intensity (exact)" or "intensity (within 0.02)", as the selection has it.
std::string describe_field(const FieldSelection& selection, std::string_view name);

bool keeps(const FieldSelection& selection, std::string_view name);

}  // namespace pointreel
