// Draco's kd-tree point clouds, by quantisation bits.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include "codecs/codec.h"

namespace pointreel {
namespace {

class Draco final : public SingleSweepCodec {
 public:
  // As draco_encoder's -qp and -cl.
  Draco(int quantisation_bits, int compression_level)
      : quantisation_bits_(quantisation_bits), compression_level_(compression_level) {}

  std::string series() const override { return "Draco"; }
  std::string settings() const override {
    return "-qp " + std::to_string(quantisation_bits_) + " -cl " + std::to_string(compression_level_);
  }
  bool carries_fields() const override { return true; }

  Result<Bytes> encode_sweep(const PointCloud& sweep) const override {
    draco::PointCloudBuilder builder;
    builder.Start(static_cast<std::uint32_t>(sweep.size()));
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    builder.SetAttributeValuesForAllPoints(positions, sweep.positions.data(), sizeof(Point3f));
    const auto cloud = builder.Finalize(false);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(10 - compression_level_, 10 - compression_level_);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, quantisation_bits_);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
    draco::EncoderBuffer buffer;
    if (const auto status = encoder.EncodePointCloudToBuffer(*cloud, &buffer); !status.ok())
      return Error{ErrorCode::unsupported, status.error_msg_string()};
    return Bytes(buffer.data(), buffer.data() + buffer.size());
  }

  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes) const override {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto decoded = draco::Decoder().DecodePointCloudFromBuffer(&buffer);
    if (!decoded.ok()) return Error{ErrorCode::corrupt, decoded.status().error_msg_string()};
    const draco::PointAttribute* positions =
        decoded.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    PointCloud cloud;
    cloud.positions.resize(decoded.value()->num_points());
    for (std::uint32_t i = 0; i < cloud.positions.size(); ++i)
      positions->GetMappedValue(draco::PointIndex(i), &cloud.positions[i]);
    return cloud;
  }

 private:
  int quantisation_bits_, compression_level_;
};

const CodecRegistration registration("draco", [] {
  Codecs codecs;
  for (const int bits : {14, 13, 12, 11, 10, 9}) codecs.push_back(std::make_unique<Draco>(bits, 10));
  return codecs;
});

}  // namespace
}  // namespace pointreel
