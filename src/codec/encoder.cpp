#include <string>
#include <utility>

#include "codec/method.h"
#include "pointreel/codec.h"

namespace pointreel {

Encoder::Encoder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;
Encoder::~Encoder() = default;

Result<Encoder> Encoder::create(const EncoderOptions& options, const Runtime& runtime) {
  const bool uniform = options.method == Method::planes && options.planes.grid == PlaneGrid::uniform;
  auto implementation =
      uniform ? make_planes_encoder(options, runtime) : make_mixture_encoder(options, runtime);
  if (!implementation) return implementation.error();
  return Encoder(*std::move(implementation));
}

const StreamHeader& Encoder::header() const {
  return implementation_->header();
}

Encoder::Packets Encoder::encode(PointCloud sweep, const std::optional<Pose>& T_world_sensor) {
  return implementation_->encode({std::move(sweep), T_world_sensor});
}

void Encoder::encode_all(const NextSweep& next, const TakePackets& take) {
  implementation_->encode_all(next, take);
}

Encoder::Packets Encoder::finish() {
  return implementation_->finish();
}

Result<void> require_whole_fields(const PointCloud& sweep) {
  for (const Field& field : sweep.fields) {
    if (field.size() != sweep.size()) {
      return Error{ErrorCode::invalid_argument, "field " + field.name + " has " +
                                                    std::to_string(field.size()) + " values for " +
                                                    std::to_string(sweep.size()) + " points"};
    }
  }
  return {};
}

}  // namespace pointreel
