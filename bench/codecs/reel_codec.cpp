#include "codecs/reel_codec.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "pointreel/reel.h"

namespace pointreel {
namespace {

// The paper's grid, which needs poses and keeps no field.
bool is_uniform(const EncoderOptions& options) {
  return options.method == Method::planes && options.planes.grid == PlaneGrid::uniform;
}

class ReelSweepEncoder final : public SweepEncoder {
 public:
  ReelSweepEncoder(const EncoderOptions& options, const DriveContext& drive)
      : encoder_(Encoder::create(options, Runtime{drive.threads})) {
    if (is_uniform(options)) poses_ = drive.T_world_sensor;
  }

  Result<std::vector<Chunk>> encode(const PointCloud& sweep) override {
    if (!encoder_) return encoder_.error();
    const auto pose = poses_.empty() ? std::optional<Pose>{} : poses_[frame_];
    ++frame_;
    return written(encoder_->encode(sweep, pose));
  }

  Result<std::vector<Chunk>> finish() override {
    if (!encoder_) return encoder_.error();
    auto chunks = written(encoder_->finish());
    if (!chunks || !writer_) return chunks;
    if (const auto done = writer_->finish(); !done) return done.error();
    chunks->push_back({take_bytes(), 0});  // the index
    return chunks;
  }

 private:
  Result<std::vector<Chunk>> written(const Result<std::vector<Packet>>& packets) {
    if (!packets) return packets.error();
    if (packets->empty()) return std::vector<Chunk>{};
    if (!writer_) {
      auto writer = ReelWriter::create(stream_, encoder_->header());
      if (!writer) return writer.error();
      writer_.emplace(*std::move(writer));
    }
    for (const Packet& packet : *packets) {
      if (const auto done = writer_->write(packet); !done) return done.error();
    }
    return std::vector<Chunk>{{take_bytes(), packets->size()}};
  }

  Bytes take_bytes() {
    const std::string text = std::exchange(stream_, std::ostringstream()).str();
    return {text.begin(), text.end()};
  }

  Result<Encoder> encoder_;
  std::span<const Pose> poses_;
  std::size_t frame_ = 0;
  std::ostringstream stream_;
  std::optional<ReelWriter> writer_;
};

class ReelSweepDecoder final : public SweepDecoder {
 public:
  explicit ReelSweepDecoder(int threads) : threads_(threads) {}

  Result<std::vector<PointCloud>> decode(const Chunk& chunk) override {
    stream_.write(reinterpret_cast<const char*>(chunk.bytes.data()),
                  static_cast<std::streamsize>(chunk.bytes.size()));
    if (chunk.sweeps == 0) return std::vector<PointCloud>{};
    if (!reader_) {
      auto reader = ReelReader::open(stream_, "reel in memory");
      if (!reader) return reader.error();
      auto decoder = Decoder::create(reader->header(), Runtime{threads_});
      if (!decoder) return decoder.error();
      reader_.emplace(*std::move(reader));
      decoder_.emplace(*std::move(decoder));
    }
    std::vector<Packet> packets;
    while (packets.size() < chunk.sweeps) {
      auto packet = reader_->read_packet();
      if (!packet) return reader_->fault().value_or(Error{ErrorCode::truncated, "a packet is missing"});
      packets.push_back(*std::move(packet));
    }
    std::vector<DecodedSweep> sweeps;
    for (auto& sweep : decoder_->decode(packets)) {
      if (!sweep) return sweep.error();
      sweeps.push_back(*std::move(sweep));
    }
    std::sort(sweeps.begin(), sweeps.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
    std::vector<PointCloud> clouds;
    for (DecodedSweep& sweep : sweeps) {
      order_kept_ = order_kept_ && sweep.order_kept;
      clouds.push_back(std::move(sweep.cloud));
    }
    return clouds;
  }
  bool order_kept() const override { return order_kept_; }

 private:
  int threads_;
  bool order_kept_ = true;
  std::stringstream stream_;
  std::optional<ReelReader> reader_;
  std::optional<Decoder> decoder_;
};

}  // namespace

bool ReelCodec::carries_fields() const {
  return !is_uniform(options_);
}

std::unique_ptr<SweepEncoder> ReelCodec::encoder(const DriveContext& drive) const {
  return std::make_unique<ReelSweepEncoder>(options_, drive);
}

std::unique_ptr<SweepDecoder> ReelCodec::decoder(const DriveContext& drive) const {
  return std::make_unique<ReelSweepDecoder>(drive.threads);
}

}  // namespace pointreel
