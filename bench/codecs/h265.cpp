// Range images as 12-bit lossless H.265 (libx265).
#include "codecs/video_coder.h"

namespace pointreel {
namespace {

VideoSettings lossless_settings() {
  return {"H.265 lossless",
          "libx265",
          "hevc",
          12,
          {{"preset", "veryslow"}, {"x265-params", "lossless=1:log-level=none:pools=none:frame-threads=1"}},
          "veryslow"};
}

Result<Codecs> settings() {
  if (!can_encode(lossless_settings()))
    return Error{ErrorCode::unsupported, "libavcodec has no 12-bit libx265"};
  // 12 bits hold ranges up to 155 m at 2 cm.
  return bounded_image_codecs([](double) { return video_coder(lossless_settings()); }, 0.02, 4095);
}

const CodecRegistration registration("h265", settings);

}  // namespace
}  // namespace pointreel
