// Range images as 10-bit H.264 (libx264): lossless over levels for a bound, and lossy over levels of 12 cm.
#include "codecs/video_coder.h"

namespace pointreel {
namespace {

constexpr std::uint16_t kMostLevel = 1023;
constexpr double kFarthest_m = 120;

VideoSettings lossless() {
  return {"H.264 lossless", "libx264", "h264", 10, {{"preset", "veryslow"}, {"qp", "0"}}, "veryslow"};
}

VideoSettings lossy(int crf) {
  return {"H.264",
          "libx264",
          "h264",
          10,
          {{"preset", "veryslow"}, {"crf", std::to_string(crf)}},
          fmt::format("crf {}, veryslow", crf)};
}

Result<Codecs> settings() {
  if (!can_encode(lossless())) return Error{ErrorCode::unsupported, "libavcodec has no 10-bit libx264"};
  // 10 bits hold ranges up to 97 m at 5 cm, and too few below.
  Codecs codecs = bounded_image_codecs([](double) { return video_coder(lossless()); }, 0.05, kMostLevel);
  for (const ImageGrid grid : {ImageGrid::sensor, ImageGrid::uniform}) {
    for (const int crf : {1, 10, 18, 26}) {
      codecs.push_back(make_image_codec(video_coder(lossy(crf)),
                                        {grid, {kFarthest_m / kMostLevel, kMostLevel}}, "10 bits"));
    }
  }
  return codecs;
}

const CodecRegistration registration("h264", settings);

}  // namespace
}  // namespace pointreel
