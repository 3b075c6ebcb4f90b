// Encoding sweeps as they arrive: from a folder that is watched, or through standard input.
#pragma once

#include "pointreel/encode_arguments.h"

namespace pointreel {

// Each packet is written and flushed before the next sweep is looked at. A sweep that cannot be read is named
// and left out. An ExitCode.
int encode_live(const EncodeArguments& arguments, const EncoderOptions& options, Encoder& encoder);

}  // namespace pointreel
