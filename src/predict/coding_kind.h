// CodingKind: which of the format's models code a frame.
#pragma once

#include <cstdint>

#include "pointreel/codec.h"

namespace pointreel {

struct CodingKind {
  bool predicted = false;  // there is a reference image
  Effort effort = Effort::balanced;
};

}  // namespace pointreel
