// Pointreel's method `mixture`: all efforts at all bounds.
#include "codecs/bounds.h"
#include "codecs/reel_codec.h"

namespace pointreel {
namespace {

std::string name_of(Effort effort) {
  return effort == Effort::fast ? "fast" : effort == Effort::balanced ? "balanced" : "max";
}

Codecs mixture_settings() {
  Codecs codecs;
  for (const Effort effort : {Effort::fast, Effort::balanced, Effort::max}) {
    for (const double bound_m : kBounds_m) {
      EncoderOptions options;
      options.mixture.max_error_m = bound_m;
      options.mixture.effort = effort;
      options.mixture.group = 30;
      codecs.push_back(std::make_unique<ReelCodec>("mixture " + name_of(effort),
                                                   "max error " + in_centimetres(bound_m), options));
    }
  }
  return codecs;
}

const CodecRegistration mixture_registration("mixture", mixture_settings);

}  // namespace
}  // namespace pointreel
