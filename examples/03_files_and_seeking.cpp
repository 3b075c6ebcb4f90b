// A drive in a file, and a single sweep out of its middle.
#include <pointreel/reel.h>
#include <pointreel/simulator.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <utility>

namespace {

constexpr const char* kPath = "example.reel";

bool record(int sweeps) {
  pointreel::EncoderOptions options;
  options.mixture.group =
      4;  // the first sweep of a group decodes by itself, each other one after the one before
  auto encoder = pointreel::Encoder::create(options);
  if (!encoder) return false;
  std::ofstream file(kPath, std::ios::binary);
  auto writer = pointreel::ReelWriter::create(file, encoder->header());
  if (!writer) return false;
  pointreel::Simulator simulator(pointreel::SimulatorOptions{.sensor = pointreel::SensorKind::vlp_16});
  for (int i = 0; i < sweeps; ++i) {
    const auto packets = encoder->encode(simulator.next_sweep().cloud);
    if (!packets) return false;
    for (const auto& packet : *packets) {
      if (!writer->write(packet)) return false;  // disk full, say
    }
  }
  return static_cast<bool>(writer->finish());  // the index; a file without one is still readable
}

bool show(std::uint32_t wanted_frame) {
  std::ifstream file(kPath, std::ios::binary);
  auto reader = pointreel::ReelReader::open(file, kPath);
  if (!reader) return false;
  auto decoder = pointreel::Decoder::create(reader->header());
  const auto index = reader->index();
  if (!decoder || !index) return false;
  // A predicted sweep needs those before it in its group.
  const auto needed = index->needed_for(wanted_frame);
  for (const auto& entry : needed) {
    if (!reader->seek(entry)) return false;
    const auto packet = reader->read_packet();
    if (!packet) return false;
    const auto sweep = std::move(decoder->decode({&*packet, 1}).front());
    if (!sweep) return false;
    std::printf("frame %u: %u bytes, %zu points\n", sweep->frame, entry.bytes, sweep->cloud.size());
  }
  return !needed.empty();
}

}  // namespace

int main() {
  return record(10) && show(6) ? 0 : 1;
}
