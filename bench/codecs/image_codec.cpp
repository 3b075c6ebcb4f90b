#include "codecs/image_codec.h"

#include <deque>

#include "base/bytes.h"

namespace pointreel {
namespace {

// A chunk is the next sweep's side and the next packet; video codecs with images ahead of others send the
// two of different sweeps together.
class ImageSweepEncoder final : public SweepEncoder {
 public:
  ImageSweepEncoder(std::unique_ptr<ImageEncoder> encoder, const ImagerSettings& settings)
      : encoder_(std::move(encoder)), imager_(settings) {}

  Result<std::vector<Chunk>> encode(const PointCloud& sweep) override {
    auto imaged = imager_.image_of(sweep);
    if (!imaged) return imaged.error();
    sides_.push_back(std::move(imaged->side));
    return chunks_of(encoder_->encode(imaged->image));
  }
  Result<std::vector<Chunk>> finish() override { return chunks_of(encoder_->finish()); }

 private:
  Result<std::vector<Chunk>> chunks_of(const Result<std::vector<Bytes>>& packets) {
    if (!packets) return packets.error();
    std::vector<Chunk> chunks;
    for (const Bytes& packet : *packets) {
      if (sides_.empty()) return Error{ErrorCode::corrupt, "more packets than images"};
      ByteWriter writer;
      writer.put(static_cast<std::uint32_t>(sides_.front().size()));
      writer.put(sides_.front());
      writer.put(packet);
      sides_.pop_front();
      chunks.push_back({writer.take(), 1});
    }
    return chunks;
  }

  std::unique_ptr<ImageEncoder> encoder_;
  SweepImager imager_;
  std::deque<Bytes> sides_;
};

class ImageSweepDecoder final : public SweepDecoder {
 public:
  ImageSweepDecoder(std::unique_ptr<ImageDecoder> decoder, const ImagerSettings& settings)
      : decoder_(std::move(decoder)), imager_(settings) {}

  Result<std::vector<PointCloud>> decode(const Chunk& chunk) override {
    ByteReader reader(chunk.bytes);
    const auto side = reader.get(reader.get<std::uint32_t>());
    sides_.emplace_back(side.begin(), side.end());
    return sweeps_of(decoder_->decode(reader.rest()));
  }
  Result<std::vector<PointCloud>> finish() override { return sweeps_of(decoder_->finish()); }

 private:
  Result<std::vector<PointCloud>> sweeps_of(const Result<std::vector<LevelImage>>& images) {
    if (!images) return images.error();
    std::vector<PointCloud> sweeps;
    for (const LevelImage& image : *images) {
      if (sides_.empty()) return Error{ErrorCode::corrupt, "more images than sweeps"};
      auto sweep = imager_.sweep_of(image, sides_.front());
      sides_.pop_front();
      if (!sweep) return sweep.error();
      sweeps.push_back(*std::move(sweep));
    }
    return sweeps;
  }

  std::unique_ptr<ImageDecoder> decoder_;
  SweepImager imager_;
  std::deque<Bytes> sides_;
};

class ImageCodec final : public Codec {
 public:
  ImageCodec(ImageCoder coder, const ImagerSettings& imager, std::string scale_settings)
      : coder_(std::move(coder)), imager_(imager), scale_settings_(std::move(scale_settings)) {}

  std::string series() const override {
    return coder_.name + (imager_.grid == ImageGrid::sensor ? ", sensor grid" : ", uniform grid");
  }
  std::string settings() const override {
    return coder_.settings.empty() ? scale_settings_ : scale_settings_ + ", " + coder_.settings;
  }
  int threads(const DriveContext& drive) const override { return coder_.uses_threads ? drive.threads : 1; }
  std::unique_ptr<SweepEncoder> encoder(const DriveContext& drive) const override {
    return std::make_unique<ImageSweepEncoder>(coder_.encoder(drive.threads), imager_);
  }
  std::unique_ptr<SweepDecoder> decoder(const DriveContext& drive) const override {
    return std::make_unique<ImageSweepDecoder>(coder_.decoder(drive.threads), imager_);
  }

 private:
  ImageCoder coder_;
  ImagerSettings imager_;
  std::string scale_settings_;
};

class StillEncoder final : public ImageEncoder {
 public:
  explicit StillEncoder(EncodeImage encode) : encode_(std::move(encode)) {}
  Result<std::vector<Bytes>> encode(const LevelImage& image) override {
    auto bytes = encode_(image);
    if (!bytes) return bytes.error();
    return std::vector<Bytes>{*std::move(bytes)};
  }

 private:
  EncodeImage encode_;
};

class StillDecoder final : public ImageDecoder {
 public:
  explicit StillDecoder(DecodeImage decode) : decode_(std::move(decode)) {}
  Result<std::vector<LevelImage>> decode(std::span<const std::uint8_t> packet) override {
    auto image = decode_(packet);
    if (!image) return image.error();
    return std::vector<LevelImage>{*std::move(image)};
  }

 private:
  DecodeImage decode_;
};

}  // namespace

std::unique_ptr<Codec> make_image_codec(ImageCoder coder, const ImagerSettings& imager,
                                        const std::string& scale_settings) {
  return std::make_unique<ImageCodec>(std::move(coder), imager, scale_settings);
}

Codecs bounded_image_codecs(const std::function<ImageCoder(double bound_m)>& coder, double least_bound_m,
                            std::uint16_t most_level) {
  constexpr double kUniformGridError_m = 0.05;
  Codecs codecs;
  for (const ImageGrid grid : {ImageGrid::sensor, ImageGrid::uniform}) {
    for (const double bound_m : kBounds_m) {
      if (bound_m < least_bound_m || (grid == ImageGrid::uniform && bound_m < kUniformGridError_m)) continue;
      ImageCoder image_coder = coder(bound_m);
      ImagerSettings imager = imager_settings(grid, bound_m, most_level);
      imager.scale.step_m /= 2 * image_coder.near + 1;
      codecs.push_back(
          make_image_codec(std::move(image_coder), imager, "levels for " + in_centimetres(bound_m)));
    }
  }
  return codecs;
}

ImageCoder still_image_coder(std::string name, std::string settings, const EncodeImage& encode,
                             const DecodeImage& decode) {
  return {std::move(name), std::move(settings),
          [encode](int) { return std::make_unique<StillEncoder>(encode); },
          [decode](int) { return std::make_unique<StillDecoder>(decode); }};
}

}  // namespace pointreel
