// Pointreel's method `planes`: on the sensor's grid, and on the paper's uniform one, sweeps by themselves and
// in groups.
#include "codecs/bounds.h"
#include "codecs/reel_codec.h"

namespace pointreel {
namespace {

constexpr std::array kThresholds_m = {0.02, 0.05, 0.1, 0.2, 0.5};

Codecs planes_settings() {
  Codecs codecs;
  for (const Effort effort : {Effort::fast, Effort::balanced}) {
    for (const double bound_m : kBounds_m) {
      EncoderOptions options;
      options.method = Method::planes;
      options.mixture.max_error_m = bound_m;
      options.mixture.effort = effort;
      options.mixture.group = 30;
      codecs.push_back(std::make_unique<ReelCodec>(
          effort == Effort::fast ? "planes sensor fast" : "planes sensor balanced",
          "max error " + in_centimetres(bound_m), options));
    }
  }
  for (const int group : {1, 5}) {
    for (const double threshold_m : kThresholds_m) {
      EncoderOptions options;
      options.method = Method::planes;
      options.planes.grid = PlaneGrid::uniform;
      options.planes.threshold_m = threshold_m;
      options.planes.group = group;
      codecs.push_back(
          std::make_unique<ReelCodec>(group == 1 ? "planes uniform" : "planes uniform, groups of 5",
                                      "threshold " + in_centimetres(threshold_m), options));
    }
  }
  return codecs;
}

const CodecRegistration planes_registration("planes", planes_settings);

}  // namespace
}  // namespace pointreel
