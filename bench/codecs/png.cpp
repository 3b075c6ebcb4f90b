// Range images as 16-bit PNG, at zlib's best level. Of the filters, differences to the left alone are as good
// as a choice for each row, or better.
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "codecs/image_codec.h"

namespace pointreel {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

void flush(png_structp /*png*/) {}

void take(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<std::span<const std::uint8_t>*>(png_get_io_ptr(png));
  if (size > bytes.size()) png_error(png, "the image is cut off");
  std::memcpy(data, bytes.data(), size);
  bytes = bytes.subspan(size);
}

void quiet(png_structp /*png*/, png_const_charp /*text*/) {}

// libpng leaves by longjmp: nothing with a destructor may live in these two.
bool write_png(png_structp png, png_infop info, const LevelImage& image, Bytes& bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append, flush);
  png_set_compression_level(png, 9);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.columns), static_cast<png_uint_32>(image.rows), 16,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(png, info);
  png_set_swap(png);
  for (int row = 0; row < image.rows; ++row)
    png_write_row(png,
                  reinterpret_cast<png_const_bytep>(
                      &image.level[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns)]));
  png_write_end(png, nullptr);
  return true;
}

bool read_png(png_structp png, png_infop info, std::span<const std::uint8_t>& bytes, LevelImage& image) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &bytes, take);
  png_read_info(png, info);
  if (png_get_bit_depth(png, info) != 16 || png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY)
    return false;
  image.rows = static_cast<int>(png_get_image_height(png, info));
  image.columns = static_cast<int>(png_get_image_width(png, info));
  const auto columns = static_cast<std::size_t>(image.columns);
  image.level.resize(static_cast<std::size_t>(image.rows) * columns);
  png_set_swap(png);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.rows); ++row)
    png_read_row(png, reinterpret_cast<png_bytep>(&image.level[row * columns]), nullptr);
  return true;
}

Result<Bytes> encode(const LevelImage& image) {
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, quiet);
  png_infop info = png_create_info_struct(png);
  const bool written = write_png(png, info, image, bytes);
  png_destroy_write_struct(&png, &info);
  if (!written) return Error{ErrorCode::unsupported, "libpng refused the image"};
  return bytes;
}

Result<LevelImage> decode(std::span<const std::uint8_t> bytes) {
  LevelImage image;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, quiet);
  png_infop info = png_create_info_struct(png);
  const bool read = read_png(png, info, bytes, image);
  png_destroy_read_struct(&png, &info, nullptr);
  if (!read) return Error{ErrorCode::corrupt, "not a 16-bit PNG"};
  return image;
}

const CodecRegistration registration("png", [] {
  return bounded_image_codecs([](double) { return still_image_coder("PNG-16", "", encode, decode); }, 0,
                              65535);
});

}  // namespace
}  // namespace pointreel
