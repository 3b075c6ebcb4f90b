// Range images as lossless JPEG XL.
#include <jxl/decode.h>
#include <jxl/encode.h>

#include "codecs/image_codec.h"

namespace pointreel {
namespace {

constexpr int kEffort = 9;
constexpr JxlPixelFormat kPixels = {1, JXL_TYPE_UINT16, JXL_NATIVE_ENDIAN, 0};

struct Destroy {
  void operator()(JxlEncoder* encoder) const { JxlEncoderDestroy(encoder); }
  void operator()(JxlDecoder* decoder) const { JxlDecoderDestroy(decoder); }
};

std::size_t bytes_of(const LevelImage& image) {
  return image.level.size() * sizeof(std::uint16_t);
}

bool add_image(JxlEncoder* encoder, const LevelImage& image) {
  JxlBasicInfo info;
  JxlEncoderInitBasicInfo(&info);
  info.xsize = static_cast<std::uint32_t>(image.columns);
  info.ysize = static_cast<std::uint32_t>(image.rows);
  info.bits_per_sample = 16;
  info.num_color_channels = 1;
  info.uses_original_profile = JXL_TRUE;
  JxlColorEncoding colors;
  JxlColorEncodingSetToSRGB(&colors, JXL_TRUE);
  JxlEncoderFrameSettings* frame = JxlEncoderFrameSettingsCreate(encoder, nullptr);
  return JxlEncoderSetCodestreamLevel(encoder, 10) == JXL_ENC_SUCCESS &&
         JxlEncoderSetBasicInfo(encoder, &info) == JXL_ENC_SUCCESS &&
         JxlEncoderSetColorEncoding(encoder, &colors) == JXL_ENC_SUCCESS &&
         JxlEncoderSetFrameLossless(frame, JXL_TRUE) == JXL_ENC_SUCCESS &&
         JxlEncoderFrameSettingsSetOption(frame, JXL_ENC_FRAME_SETTING_EFFORT, kEffort) == JXL_ENC_SUCCESS &&
         JxlEncoderAddImageFrame(frame, &kPixels, image.level.data(), bytes_of(image)) == JXL_ENC_SUCCESS;
}

Result<Bytes> encode(const LevelImage& image) {
  const std::unique_ptr<JxlEncoder, Destroy> encoder(JxlEncoderCreate(nullptr));
  if (!add_image(encoder.get(), image)) return Error{ErrorCode::unsupported, "libjxl refused the image"};
  JxlEncoderCloseInput(encoder.get());
  Bytes bytes(bytes_of(image) + 4096);
  std::uint8_t* next = bytes.data();
  std::size_t left = bytes.size();
  if (JxlEncoderProcessOutput(encoder.get(), &next, &left) != JXL_ENC_SUCCESS)
    return Error{ErrorCode::unsupported, "libjxl failed to encode"};
  bytes.resize(bytes.size() - left);
  return bytes;
}

Result<LevelImage> decode(std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<JxlDecoder, Destroy> decoder(JxlDecoderCreate(nullptr));
  JxlDecoderSubscribeEvents(decoder.get(), JXL_DEC_BASIC_INFO | JXL_DEC_FULL_IMAGE);
  JxlDecoderSetInput(decoder.get(), bytes.data(), bytes.size());
  JxlDecoderCloseInput(decoder.get());
  LevelImage image;
  for (;;) {
    switch (JxlDecoderProcessInput(decoder.get())) {
      case JXL_DEC_BASIC_INFO: {
        JxlBasicInfo info;
        JxlDecoderGetBasicInfo(decoder.get(), &info);
        image.rows = static_cast<int>(info.ysize);
        image.columns = static_cast<int>(info.xsize);
        image.level.resize(std::size_t{info.ysize} * info.xsize);
        break;
      }
      case JXL_DEC_NEED_IMAGE_OUT_BUFFER:
        JxlDecoderSetImageOutBuffer(decoder.get(), &kPixels, image.level.data(), bytes_of(image));
        break;
      case JXL_DEC_FULL_IMAGE:
        return image;
      default:
        return Error{ErrorCode::corrupt, "not a JPEG XL image"};
    }
  }
}

const CodecRegistration registration("jpegxl", [] {
  return bounded_image_codecs(
      [](double) {
        return still_image_coder("JPEG XL", "effort " + std::to_string(kEffort), encode, decode);
      },
      0, 65535);
});

}  // namespace
}  // namespace pointreel
