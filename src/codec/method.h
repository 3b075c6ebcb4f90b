// What a compression method implements behind Encoder and Decoder.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

class Encoder::Implementation {
 public:
  using Packets = Encoder::Packets;
  using NextSweep = Encoder::NextSweep;
  using TakePackets = Encoder::TakePackets;
  virtual ~Implementation() = default;
  virtual const StreamHeader& header() const = 0;
  virtual Packets encode(PosedSweep sweep) = 0;
  virtual void encode_all(const NextSweep& next, const TakePackets& take) {
    while (auto sweep = next()) {
      if (!take(encode(*std::move(sweep)))) return;
    }
  }
  virtual Packets finish() = 0;
};

// Error: invalid_argument for a field whose number of values is not that of the points.
Result<void> require_whole_fields(const PointCloud& sweep);

class Decoder::Implementation {
 public:
  virtual ~Implementation() = default;
  virtual std::vector<Result<DecodedSweep>> decode(std::span<const Packet> packets) = 0;
  virtual Result<SweepPlanes> decode_planes(const Packet& /*packet*/) {
    return Error{ErrorCode::unsupported, "only method planes on the sensor's grid hands out planes"};
  }
};

// codec/mixture_encoder.cpp, codec/mixture_decoder.cpp: both methods on the sensor's grid
Result<std::unique_ptr<Encoder::Implementation>> make_mixture_encoder(const EncoderOptions& options,
                                                                      const Runtime& runtime);
Result<std::unique_ptr<Decoder::Implementation>> make_mixture_decoder(const StreamHeader& header,
                                                                      const Runtime& runtime);
Result<std::vector<std::int64_t>> pair_mixture_points(const StreamHeader& header, const PointCloud& original,
                                                      const DecodedSweep& decoded);

// codec/planes_encoder.cpp, codec/planes_decoder.cpp: planes on the uniform grid
Result<std::unique_ptr<Encoder::Implementation>> make_planes_encoder(const EncoderOptions& options,
                                                                     const Runtime& runtime);
Result<std::unique_ptr<Decoder::Implementation>> make_planes_decoder(const StreamHeader& header,
                                                                     const Runtime& runtime);

Result<std::vector<std::int64_t>> pair_planes_points(const StreamHeader& header, const PointCloud& original,
                                                     const DecodedSweep& decoded);

}  // namespace pointreel
