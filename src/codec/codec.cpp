#include "pointreel/codec.h"

#include <string>

#include "codec/method.h"
#include "codec/wire.h"

namespace pointreel {

Encoder::Encoder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;
Encoder::~Encoder() = default;

Result<Encoder> Encoder::create(const EncoderOptions& options, const Runtime& runtime) {
  auto implementation = options.method == Method::planes ? make_planes_encoder(options, runtime)
                                                         : make_mixture_encoder(options, runtime);
  if (!implementation) return implementation.error();
  return Encoder(*std::move(implementation));
}

const StreamHeader& Encoder::header() const {
  return implementation_->header();
}

Result<std::vector<Packet>> Encoder::encode(PointCloud sweep, const std::optional<Pose>& T_world_sensor) {
  return implementation_->encode(std::move(sweep), T_world_sensor);
}

Result<std::vector<Packet>> Encoder::finish() {
  return implementation_->finish();
}

Decoder::Decoder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

Result<Decoder> Decoder::create(const StreamHeader& header, const Runtime& runtime) {
  auto implementation = header.method == Method::planes ? make_planes_decoder(header, runtime)
                                                        : make_mixture_decoder(header, runtime);
  if (!implementation) return implementation.error();
  return Decoder(*std::move(implementation));
}

std::vector<Result<DecodedSweep>> Decoder::decode(std::span<const Packet> packets) {
  return implementation_->decode(packets);
}

Result<std::vector<std::int64_t>> pair_points(const StreamHeader& header, const PointCloud& original,
                                              const DecodedSweep& decoded) {
  return header.method == Method::planes ? pair_planes_points(header, original, decoded)
                                         : pair_mixture_points(header, original, decoded);
}

const FieldStep* FieldSelection::find(std::string_view name) const {
  for (const FieldStep& field : named) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

}  // namespace pointreel
