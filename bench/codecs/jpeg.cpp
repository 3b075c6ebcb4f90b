// Range images as 8-bit JPEG, progressive, over levels that grow with the square root of the range.
#include <turbojpeg.h>

#include "codecs/image_codec.h"

namespace pointreel {
namespace {

constexpr double kFarthest_m = 120;

Result<Bytes> encode(const LevelImage& image, int quality) {
  const Bytes pixels(image.level.begin(), image.level.end());
  const tjhandle jpeg = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(jpeg, pixels.data(), image.columns, 0, image.rows, TJPF_GRAY, &data, &size,
                                 TJSAMP_GRAY, quality, TJFLAG_PROGRESSIVE | TJFLAG_ACCURATEDCT);
  Bytes bytes(data, data + size);
  tjFree(data);
  tjDestroy(jpeg);
  if (failed != 0) return Error{ErrorCode::unsupported, "libjpeg refused the image"};
  return bytes;
}

Result<LevelImage> decode(std::span<const std::uint8_t> bytes) {
  const tjhandle jpeg = tjInitDecompress();
  LevelImage image;
  int subsampling = 0, colorspace = 0;
  int failed = tjDecompressHeader3(jpeg, bytes.data(), bytes.size(), &image.columns, &image.rows,
                                   &subsampling, &colorspace);
  Bytes pixels(static_cast<std::size_t>(image.rows) * static_cast<std::size_t>(image.columns));
  if (failed == 0) {
    failed = tjDecompress2(jpeg, bytes.data(), bytes.size(), pixels.data(), image.columns, 0, image.rows,
                           TJPF_GRAY, TJFLAG_ACCURATEDCT);
  }
  tjDestroy(jpeg);
  if (failed != 0) return Error{ErrorCode::corrupt, "not a JPEG"};
  image.level.assign(pixels.begin(), pixels.end());
  return image;
}

Codecs settings() {
  Codecs codecs;
  for (const ImageGrid grid : {ImageGrid::sensor, ImageGrid::uniform}) {
    for (const int quality : {100, 95, 85, 60}) {
      const ImagerSettings imager{grid, {kFarthest_m / (255.0 * 255.0), 255, true}};
      codecs.push_back(
          make_image_codec(still_image_coder(
                               "JPEG", "quality " + std::to_string(quality),
                               [quality](const LevelImage& image) { return encode(image, quality); }, decode),
                           imager, "8 bits"));
    }
  }
  return codecs;
}

const CodecRegistration registration("jpeg", settings);

}  // namespace
}  // namespace pointreel
