// Pointreel's method `planes`, the paper's: on its uniform grid, sweeps by themselves and in groups.
#include "codecs/bounds.h"
#include "codecs/reel_codec.h"

namespace pointreel {
namespace {

constexpr std::array kThresholds_m = {0.02, 0.05, 0.1, 0.2, 0.5};

Codecs planes_settings() {
  Codecs codecs;
  // Another grid is another series: its name goes before the mode.
  for (const int group : {1, 5}) {
    for (const double threshold_m : kThresholds_m) {
      EncoderOptions options;
      options.method = Method::planes;
      options.planes.threshold_m = threshold_m;
      options.planes.group = group;
      codecs.push_back(
          std::make_unique<ReelCodec>(group == 1 ? "planes uniform" : "planes uniform, groups of 5",
                                      "threshold " + in_centimetres(threshold_m), options));
    }
  }
  return codecs;
}

const CodecRegistration registration("planes", planes_settings);

}  // namespace
}  // namespace pointreel
