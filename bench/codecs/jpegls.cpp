// Range images as near-lossless JPEG-LS: finer levels than needed, of which the codec may miss a few.
#include <charls/charls.h>

#include "codecs/image_codec.h"

namespace pointreel {
namespace {

// Of NEAR 0, 1 and 4, each with levels as much finer, these give the smallest streams.
int best_near(double bound_m) {
  return bound_m < 0.05 ? 1 : 4;
}

Result<Bytes> encode(const LevelImage& image, int near) {
  try {
    charls::jpegls_encoder encoder;
    encoder
        .frame_info(
            {static_cast<std::uint32_t>(image.columns), static_cast<std::uint32_t>(image.rows), 16, 1})
        .near_lossless(near);
    Bytes bytes(encoder.estimated_destination_size());
    encoder.destination(bytes);
    bytes.resize(encoder.encode(image.level));
    return bytes;
  } catch (const charls::jpegls_error& error) {
    return Error{ErrorCode::unsupported, error.what()};
  }
}

Result<LevelImage> decode(std::span<const std::uint8_t> bytes) {
  try {
    charls::jpegls_decoder decoder;
    decoder.source(bytes.data(), bytes.size()).read_header();
    LevelImage image;
    image.rows = static_cast<int>(decoder.frame_info().height);
    image.columns = static_cast<int>(decoder.frame_info().width);
    image.level = decoder.decode<std::vector<std::uint16_t>>();
    return image;
  } catch (const charls::jpegls_error& error) {
    return Error{ErrorCode::corrupt, error.what()};
  }
}

ImageCoder coder(double bound_m) {
  const int near = best_near(bound_m);
  ImageCoder coder = still_image_coder(
      "JPEG-LS", fmt::format("NEAR {}", near),
      [near](const LevelImage& image) { return encode(image, near); }, decode);
  coder.near = near;
  return coder;
}

const CodecRegistration registration("jpegls", [] { return bounded_image_codecs(coder, 0, 65534); });

}  // namespace
}  // namespace pointreel
