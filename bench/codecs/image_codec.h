// Image and video codecs behind the bench's interface: a range image a sweep.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "codecs/bounds.h"
#include "codecs/codec.h"
#include "codecs/range_imager.h"

namespace pointreel {

// Images in their order; a packet may come later than its image, but there is one for each.
class ImageEncoder {
 public:
  virtual ~ImageEncoder() = default;
  virtual Result<std::vector<Bytes>> encode(const LevelImage& image) = 0;
  virtual Result<std::vector<Bytes>> finish() { return std::vector<Bytes>{}; }
};

class ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  virtual Result<std::vector<LevelImage>> decode(std::span<const std::uint8_t> packet) = 0;
  virtual Result<std::vector<LevelImage>> finish() { return std::vector<LevelImage>{}; }
};

struct ImageCoder {
  std::string name;      // "PNG-16"
  std::string settings;  // of the coder; "" when there are none
  std::function<std::unique_ptr<ImageEncoder>(int threads)> encoder;
  std::function<std::unique_ptr<ImageDecoder>(int threads)> decoder;
  bool uses_threads = false;
  int near = 0;  // levels that it may be off by
};

// `scale_settings`: what the levels are, for settings().
std::unique_ptr<Codec> make_image_codec(ImageCoder coder, const ImagerSettings& imager,
                                        const std::string& scale_settings);

// A coder that keeps levels, exactly or to `near` of them, on both grids at all bounds from `least_bound_m`
// on; from 5 cm on the uniform grid, whose own rounding is larger than anything below. `coder` is asked for
// each bound.
Codecs bounded_image_codecs(const std::function<ImageCoder(double bound_m)>& coder, double least_bound_m,
                            std::uint16_t most_level);

// Still images: one function each way.
using EncodeImage = std::function<Result<Bytes>(const LevelImage&)>;
using DecodeImage = std::function<Result<LevelImage>(std::span<const std::uint8_t>)>;
ImageCoder still_image_coder(std::string name, std::string settings, const EncodeImage& encode,
                             const DecodeImage& decode);

}  // namespace pointreel
