#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "pointreel/pointreel.h"

namespace pointreel {

Result<std::vector<std::uint8_t>> encode(std::span<const PointCloud> sweeps, const EncoderOptions& options,
                                         std::span<const Pose> T_world_sensor, const Runtime& runtime) {
  if (!T_world_sensor.empty() && T_world_sensor.size() != sweeps.size()) {
    return Error{ErrorCode::invalid_argument, std::to_string(T_world_sensor.size()) + " poses for " +
                                                  std::to_string(sweeps.size()) + " sweeps"};
  }
  auto encoder = Encoder::create(options, runtime);
  if (!encoder) return encoder.error();
  std::ostringstream stream;
  auto writer = ReelWriter::create(stream, encoder->header());
  if (!writer) return writer.error();
  Result<void> good;
  const auto write = [&](const Encoder::Packets& packets) {
    if (!packets) good = packets.error();
    for (std::size_t i = 0; good && i < packets->size(); ++i) good = writer->write((*packets)[i]);
    return static_cast<bool>(good);
  };
  std::size_t taken = 0;
  const auto next = [&]() -> std::optional<PosedSweep> {
    if (taken == sweeps.size()) return std::nullopt;
    PosedSweep sweep{sweeps[taken], {}};
    if (!T_world_sensor.empty()) sweep.T_world_sensor = T_world_sensor[taken];
    ++taken;
    return sweep;
  };
  encoder->encode_all(next, write);
  if (good) write(encoder->finish());
  if (!good) return good.error();
  if (auto written = writer->finish(); !written) return written.error();
  const std::string_view bytes = stream.view();
  return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

Result<std::vector<DecodedSweep>> decode(std::span<const std::uint8_t> reel, const Runtime& runtime) {
  std::istringstream stream(std::string(reel.begin(), reel.end()));
  auto reader = ReelReader::open(stream, "reel");
  if (!reader) return reader.error();
  auto decoder = Decoder::create(reader->header(), runtime);
  if (!decoder) return decoder.error();

  std::vector<DecodedSweep> sweeps;
  std::vector<Packet> group;  // is decoded in parallel
  const auto decode_group = [&]() -> Result<void> {
    for (auto& sweep : decoder->decode(group)) {
      if (!sweep) return sweep.error();
      sweeps.push_back(*std::move(sweep));
    }
    group.clear();
    return {};
  };
  while (auto packet = reader->read_packet()) {
    if (!group.empty() && group.front().group != packet->group) {
      if (auto decoded = decode_group(); !decoded) return decoded.error();
    }
    group.push_back(*std::move(packet));
  }
  if (reader->fault()) return *reader->fault();
  if (auto decoded = decode_group(); !decoded) return decoded.error();
  std::stable_sort(sweeps.begin(), sweeps.end(),
                   [](const DecodedSweep& a, const DecodedSweep& b) { return a.frame < b.frame; });
  return sweeps;
}

}  // namespace pointreel
