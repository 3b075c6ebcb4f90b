// Method `planes`: project -> key frame spatially -> predicted frames temporally, then spatially -> packets.
#include <utility>

#include "base/parallel.h"
#include "codec/method.h"
#include "codec/relative_pose.h"
#include "codec/wire.h"
#include "planes/frame_coding.h"
#include "planes/projection.h"

namespace pointreel {
namespace {

class PlanesEncoder final : public Encoder::Implementation {
 public:
  PlanesEncoder(const StreamHeader& header, AngularGrid grid, int threads)
      : header_(header),
        grid_(std::move(grid)),
        settings_(frame_settings(header.planes)),
        threads_(threads) {}

  const StreamHeader& header() const override { return header_; }

  Packets encode(PosedSweep sweep) override {
    if (const auto valid = require_whole_fields(sweep.cloud); !valid) return valid.error();
    group_.push_back({std::move(sweep.cloud), sweep.T_world_sensor.value_or(Pose::Identity())});
    if (static_cast<int>(group_.size()) < header_.planes.group) return std::vector<Packet>{};
    return finish();
  }

  Packets finish() override {
    if (group_.empty()) return std::vector<Packet>{};
    auto packets = encode_group();
    next_frame_ += static_cast<std::uint32_t>(group_.size());
    ++next_group_;
    group_.clear();
    return packets;
  }

 private:
  struct Sweep {
    PointCloud cloud;
    Pose T_world_sensor;
  };

  Packets encode_group() {
    const std::size_t count = group_.size();
    const std::size_t key = count / 2;  // the middle one: least motion to the others

    // Paper III-D: every predicted cloud is moved into the key frame's coordinates, then projected.
    std::vector<Pose> T_key_sensor(count, Pose::Identity());
    for (std::size_t i = 0; i < count; ++i) {
      if (i == key) continue;
      auto pose = quantised(group_[key].T_world_sensor.inverse() * group_[i].T_world_sensor);
      if (!pose)
        return Error{ErrorCode::invalid_argument,
                     "pose of frame " + std::to_string(next_frame_ + i) + ": " + pose.error().message};
      T_key_sensor[i] = *std::move(pose);
    }
    std::vector<Result<RangeImage>> images(count, RangeImage{});
    const int threads_per_cloud = count == 1 ? threads_ : 1;
    parallel_for(count, threads_, [&](std::size_t i) {
      const auto points = project_points(grid_, group_[i].cloud, T_key_sensor[i], threads_per_cloud);
      images[i] = range_image_of(grid_, points, settings_.tile_size);
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (!images[i]) {
        return Error{images[i].error().code,
                     "frame " + std::to_string(next_frame_ + i) + ": " + images[i].error().message};
      }
    }

    std::vector<CodedFrame> frames(count);
    frames[key] = encode_frame(grid_, *images[key], settings_, nullptr, threads_);
    parallel_for(count, threads_, [&](std::size_t i) {
      if (i != key) frames[i] = encode_frame(grid_, *images[i], settings_, &frames[key].decoded, 1);
    });

    std::vector<Packet> packets = {packet(key, key, T_key_sensor[key], std::move(frames[key]))};
    for (std::size_t i = 0; i < count; ++i) {
      if (i != key) packets.push_back(packet(i, key, T_key_sensor[i], std::move(frames[i])));
    }
    return packets;
  }

  Packet packet(std::size_t i, std::size_t key, const Pose& T_key_sensor, CodedFrame frame) const {
    Packet packet;
    packet.frame = next_frame_ + static_cast<std::uint32_t>(i);
    packet.group = next_group_;
    packet.reference_frame = next_frame_ + static_cast<std::uint32_t>(key);
    packet.kind = i == key ? FrameKind::key : FrameKind::predicted;
    packet.points_in = static_cast<std::uint32_t>(group_[i].cloud.size());
    packet.non_finite = static_cast<std::uint32_t>(group_[i].cloud.count_non_finite());
    packet.statistics = frame.statistics;
    packet.points_out =
        frame.statistics.spatial_cells + frame.statistics.temporal_cells + frame.statistics.unfit_cells;
    ByteWriter writer;
    if (packet.kind == FrameKind::predicted) put_relative_pose(writer, T_key_sensor);
    writer.put(std::span(std::as_const(frame.bytes)));
    packet.payload = writer.take();
    return packet;
  }

  StreamHeader header_;
  AngularGrid grid_;
  FrameSettings settings_;
  int threads_;
  std::vector<Sweep> group_;
  std::uint32_t next_frame_ = 0;
  std::uint32_t next_group_ = 0;
};

}  // namespace

Result<std::unique_ptr<Encoder::Implementation>> make_planes_encoder(const EncoderOptions& options,
                                                                     const Runtime& runtime) {
  StreamHeader header;
  header.method = options.method;
  header.planes = options.planes;
  if (header.planes.residual_mode == ResidualMode::stepped && header.planes.residual_step_m == 0) {
    header.planes.residual_step_m = 2 * header.planes.threshold_m;
  }
  if (const auto valid = validate(header); !valid) return valid.error();
  auto grid = AngularGrid::create(header.planes.azimuth_step_rad, header.planes.elevation_step_rad);
  if (!grid) return grid.error();
  return std::unique_ptr<Encoder::Implementation>(
      std::make_unique<PlanesEncoder>(header, *std::move(grid), resolve_threads(runtime.threads)));
}

}  // namespace pointreel
