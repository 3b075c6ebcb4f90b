// Cloudini through its converter of ROS bags, where that is on PATH: the only one of its programs that goes
// both ways. Coordinates by steps, differences from point to point, zstd of the bag (1 to 2 % smaller than
// Cloudini's own).
#include <cmath>

#include "codecs/bounds.h"
#include "codecs/float_positions.h"
#include "codecs/mcap.h"
#include "codecs/program_codec.h"

namespace pointreel {
namespace {

// A sensor_msgs/msg/PointCloud2 in CDR, up to the points. Numbers of four bytes are aligned, from behind the
// first four.
Bytes message_header(std::size_t points) {
  Bytes out = {0, 1, 0, 0};  // little-endian CDR
  const auto number = [&out](std::size_t value) {
    while (out.size() % 4 != 0) out.push_back(0);
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  const auto text = [&](const std::string& value) {
    number(value.size() + 1);
    out.insert(out.end(), value.begin(), value.end());
    out.push_back(0);
  };
  number(0);  // the time, in seconds and nanoseconds
  number(0);
  text("");   // the frame
  number(1);  // height and width
  number(points);
  number(3);
  std::size_t offset = 0;
  for (const char* field : {"x", "y", "z"}) {
    text(field);
    number(offset);
    out.push_back(7);  // float32
    number(1);
    offset += sizeof(float);
  }
  out.push_back(0);  // little-endian
  number(sizeof(Point3f));
  number(points * sizeof(Point3f));  // a row
  number(points * sizeof(Point3f));  // all
  return out;
}

class CloudiniEncoder final : public ProgramEncoder {
 public:
  CloudiniEncoder(std::filesystem::path program, double step_m)
      : ProgramEncoder(std::move(program)), step_m_(step_m) {}

 private:
  Result<Bytes> encode_sweep(const PointCloud& sweep, ProgramRunner& runner) override {
    Bytes message = message_header(sweep.size());
    const auto points = bytes_of(sweep.positions);
    message.insert(message.end(), points.begin(), points.end());
    message.push_back(1);  // all are finite
    auto written =
        write_bytes(runner.file("in.mcap"), mcap::file_of_message("sensor_msgs/msg/PointCloud2", message));
    if (!written) return written.error();
    auto ran = runner.run({"--compress", "--yes", "--filename", runner.file("in.mcap"), "--output",
                           runner.file("out.mcap"), "--resolution", fmt::format("{:.9f}", step_m_),
                           "--method", "zstd"});
    if (!ran) return ran.error();
    const auto file = read_bytes(runner.file("out.mcap"));
    if (!file) return file.error();
    return mcap::chunk_of_file(*file);
  }

  double step_m_;
};

class CloudiniDecoder final : public ProgramDecoder {
 public:
  using ProgramDecoder::ProgramDecoder;
  bool order_kept() const override { return true; }

 private:
  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes, ProgramRunner& runner) override {
    if (auto written = write_bytes(runner.file("in.mcap"), mcap::file_of_chunk(bytes)); !written)
      return written.error();
    auto ran = runner.run({"--decode", "--yes", "--filename", runner.file("in.mcap"), "--output",
                           runner.file("out.mcap"), "--method", "none"});
    if (!ran) return ran.error();
    const auto file = read_bytes(runner.file("out.mcap"));
    if (!file) return file.error();
    const auto chunk = mcap::chunk_of_file(*file);
    if (!chunk) return chunk.error();
    const auto message = mcap::message_of_chunk(*chunk);
    if (!message) return message.error();
    // It says of the points what the encoder's message said.
    const std::size_t before = message_header(0).size();
    if (message->size() <= before) return Error{ErrorCode::corrupt, "Cloudini's message is cut off"};
    return cloud_of_bytes(std::span(*message).subspan(before, message->size() - before - 1));
  }
};

class Cloudini final : public Codec {
 public:
  Cloudini(std::filesystem::path program, std::string settings, double step_m)
      : program_(std::move(program)), settings_(std::move(settings)), step_m_(step_m) {}

  std::string series() const override { return "Cloudini"; }
  std::string settings() const override { return settings_; }
  bool carries_fields() const override { return true; }
  std::unique_ptr<SweepEncoder> encoder(const DriveContext&) const override {
    return std::make_unique<CloudiniEncoder>(program_, step_m_);
  }
  std::unique_ptr<SweepDecoder> decoder(const DriveContext&) const override {
    return std::make_unique<CloudiniDecoder>(program_);
  }

 private:
  std::filesystem::path program_;
  std::string settings_;
  double step_m_;
};

Result<Codecs> cloudini_settings() {
  const std::string name = "cloudini_rosbag_converter";
  const auto program = find_program(name);
  if (!program) return Error{ErrorCode::unsupported, "no program " + name + " on PATH"};
  Codecs codecs;
  codecs.push_back(std::make_unique<Cloudini>(*program, "max error 0.09 cm, steps of 1 mm", 0.001));
  constexpr double kRounding_m = 3e-5;  // of float32, at 200 m
  for (const double bound_m : kBounds_m) {
    // The corner of a cube is sqrt(3) / 2 of its side away from the centre. Whole micrometres: Cloudini's
    // decoder is told six digits of the step.
    const double step_m = std::floor((bound_m - kRounding_m) * 2e6 / std::sqrt(3.0)) / 1e6;
    codecs.push_back(std::make_unique<Cloudini>(*program, "max error " + in_centimetres(bound_m), step_m));
  }
  return codecs;
}

const CodecRegistration cloudini_registration("cloudini", cloudini_settings);

}  // namespace
}  // namespace pointreel
