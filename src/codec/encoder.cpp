#include "codec/method.h"
#include "pointreel/codec.h"

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

const FieldStep* FieldSelection::find(std::string_view name) const {
  for (const FieldStep& field : named) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

}  // namespace pointreel
