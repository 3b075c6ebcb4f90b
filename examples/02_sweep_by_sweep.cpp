// A live stream: each sweep becomes packets at once, which a radio link or a message bus carries to a
// decoder.
#include <pointreel/codec.h>
#include <pointreel/simulator.h>

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace {

// The receiver. What arrives may be damaged or cut off: every step says so and goes on with the next packet.
void receive(pointreel::Decoder& decoder, const std::vector<std::uint8_t>& message) {
  const auto packet = pointreel::parse_packet(message);
  if (!packet) {
    std::printf("  lost: %s\n", packet.error().message.c_str());
    return;
  }
  for (const auto& sweep : decoder.decode({&*packet, 1})) {
    if (sweep)
      std::printf("  sweep %u: %zu points\n", sweep->frame, sweep->cloud.size());
    else
      std::printf("  lost: %s\n", sweep.error().message.c_str());
  }
}

}  // namespace

int main() {
  auto encoder = pointreel::Encoder::create({});
  if (!encoder) return 1;
  // The header goes first, once: the decoder needs nothing else.
  const std::vector<std::uint8_t> header = pointreel::serialize(encoder->header());
  const auto received_header = pointreel::parse_stream_header(header);
  if (!received_header) return 1;
  auto decoder = pointreel::Decoder::create(*received_header);
  if (!decoder) return 1;

  pointreel::Simulator simulator(pointreel::SimulatorOptions{.sensor = pointreel::SensorKind::vlp_16});
  for (int i = 0; i < 4; ++i) {
    const auto packets = encoder->encode(simulator.next_sweep().cloud);
    if (!packets) return 1;
    for (const pointreel::Packet& packet : *packets) {
      std::vector<std::uint8_t> message = pointreel::serialize(packet);
      std::printf("packet of frame %u: %zu bytes\n", packet.frame, message.size());
      if (i == 2) message[message.size() / 2] ^= 1;  // noise on the link: the checksum finds it
      receive(*decoder, message);
    }
  }
  // Method `planes` holds sweeps back until their group is full; finish() gives the rest. Here it is empty.
  return encoder->finish() ? 0 : 1;
}
