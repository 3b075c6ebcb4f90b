#include "codec/method.h"
#include "codec/packet_groups.h"
#include "pointreel/codec.h"

namespace pointreel {

Decoder::Decoder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

Result<Decoder> Decoder::create(const StreamHeader& header, const Runtime& runtime) {
  auto implementation =
      header.on_sensor_grid() ? make_mixture_decoder(header, runtime) : make_planes_decoder(header, runtime);
  if (!implementation) return implementation.error();
  return Decoder(*std::move(implementation));
}

std::vector<Result<DecodedSweep>> Decoder::decode(std::span<const Packet> packets) {
  return implementation_->decode(packets);
}

std::vector<Result<SweepPlanes>> Decoder::decode_planes(std::span<const Packet> packets) {
  std::vector<Result<SweepPlanes>> sweeps;
  sweeps.reserve(packets.size());
  for (const Packet& packet : packets) {
    auto planes = implementation_->decode_planes(packet);
    if (!planes) planes = in_frame(packet, planes.error());
    sweeps.push_back(std::move(planes));
  }
  return sweeps;
}

Result<std::vector<std::int64_t>> pair_points(const StreamHeader& header, const PointCloud& original,
                                              const DecodedSweep& decoded) {
  return header.on_sensor_grid() ? pair_mixture_points(header, original, decoded)
                                 : pair_planes_points(header, original, decoded);
}

}  // namespace pointreel
