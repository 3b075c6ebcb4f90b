// Method `planes`, the way back: packets -> key frame -> predicted frames -> points in each sweep's own
// coordinates.
#include <algorithm>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "codec/method.h"
#include "codec/packet_groups.h"
#include "codec/relative_pose.h"
#include "codec/wire.h"
#include "planes/frame_coding.h"
#include "planes/projection.h"

namespace pointreel {
namespace {

class PlanesDecoder final : public Decoder::Implementation {
 public:
  PlanesDecoder(const StreamHeader& header, AngularGrid grid, int threads)
      : grid_(std::move(grid)), settings_(frame_settings(header.planes)), threads_(threads) {}

  std::vector<Result<DecodedSweep>> decode(std::span<const Packet> packets) override {
    return decode_by_groups(packets, threads_,
                            [this](std::span<const Packet> groups) { return decode_groups(groups); });
  }

 private:
  struct DecodedKey {
    std::uint32_t frame = 0;
    KeyFrame key;
  };

  // All key frames in parallel, then all predicted ones.
  std::vector<Result<DecodedSweep>> decode_groups(std::span<const Packet> packets) {
    std::vector<Result<DecodedSweep>> sweeps(packets.size(), DecodedSweep{});
    std::vector<std::size_t> key_packets, predicted_packets;
    std::vector<std::size_t> keys_before(packets.size());  // of this call, for each predicted frame
    for (std::size_t i = 0; i < packets.size(); ++i) {
      (packets[i].kind == FrameKind::key ? key_packets : predicted_packets).push_back(i);
      keys_before[i] = key_packets.size();
    }
    std::vector<std::optional<DecodedKey>> keys(key_packets.size());
    parallel_for(keys.size(), threads_, [&](std::size_t k) {
      sweeps[key_packets[k]] = decode_key(packets[key_packets[k]], keys[k]);
    });
    parallel_for(predicted_packets.size(), threads_, [&](std::size_t p) {
      const std::size_t i = predicted_packets[p];
      sweeps[i] = decode_predicted(packets[i], keys_before[i] == 0 ? last_key_ : keys[keys_before[i] - 1]);
    });
    if (!keys.empty()) last_key_ = std::move(keys.back());
    return sweeps;
  }

  Result<DecodedSweep> decode_key(const Packet& packet, std::optional<DecodedKey>& key) const {
    auto frame = decode_frame(grid_, packet.payload, settings_, nullptr);
    if (!frame) return in_frame(packet, frame.error());
    key = DecodedKey{packet.frame, *std::move(frame)};
    return sweep_of(packet, key->key.image, Pose::Identity());
  }

  Result<DecodedSweep> decode_predicted(const Packet& packet, const std::optional<DecodedKey>& key) const {
    if (!key || key->frame != packet.reference_frame) {
      return in_frame(packet,
                      {ErrorCode::corrupt, "its reference frame " + std::to_string(packet.reference_frame) +
                                               " was not decoded before it"});
    }
    ByteReader reader(packet.payload);
    const auto T_key_sensor = get_relative_pose(reader);
    if (!T_key_sensor) return in_frame(packet, T_key_sensor.error());
    const auto frame = decode_frame(grid_, reader.rest(), settings_, &key->key);
    if (!frame) return in_frame(packet, frame.error());
    return sweep_of(packet, frame->image, *T_key_sensor);
  }

  Result<DecodedSweep> sweep_of(const Packet& packet, const RangeImage& image,
                                const Pose& T_key_sensor) const {
    // Before the cloud is made, so that its size is the one the packet states.
    const auto points =
        std::count_if(image.range_m.begin(), image.range_m.end(), [](float range_m) { return range_m > 0; });
    if (points != static_cast<std::ptrdiff_t>(packet.points_out)) {
      return in_frame(packet,
                      {ErrorCode::corrupt, "it decodes to " + std::to_string(points) + " points instead of " +
                                               std::to_string(packet.points_out)});
    }
    return DecodedSweep{packet.frame, cloud_of(grid_, image, T_key_sensor), T_key_sensor, false};
  }

  AngularGrid grid_;
  FrameSettings settings_;
  int threads_;
  std::optional<DecodedKey> last_key_;  // of the packets before this call
};

}  // namespace

Result<std::unique_ptr<Decoder::Implementation>> make_planes_decoder(const StreamHeader& header,
                                                                     const Runtime& runtime) {
  if (const auto valid = validate(header); !valid) return valid.error();
  auto grid = AngularGrid::create(header.planes.azimuth_step_rad, header.planes.elevation_step_rad);
  if (!grid) return grid.error();
  return std::unique_ptr<Decoder::Implementation>(
      std::make_unique<PlanesDecoder>(header, *std::move(grid), resolve_threads(runtime.threads)));
}

// The encoder's projection repeated: decoded points are the occupied cells in raster order, and a cell
// belongs to the first of its nearest points.
Result<std::vector<std::int64_t>> pair_planes_points(const StreamHeader& header, const PointCloud& original,
                                                     const DecodedSweep& decoded) {
  if (const auto valid = validate(header); !valid) return valid.error();
  const auto grid = AngularGrid::create(header.planes.azimuth_step_rad, header.planes.elevation_step_rad);
  if (!grid) return grid.error();
  const auto projected = project_points(*grid, original, decoded.T_key_sensor);
  const auto image = range_image_of(*grid, projected, header.planes.tile_size);
  if (!image) return image.error();

  std::vector<std::int64_t> point_of_cell(image->range_m.size(), -1);
  std::int64_t next = 0;
  for (std::size_t cell = 0; cell < point_of_cell.size(); ++cell) {
    if (image->range_m[cell] > 0) point_of_cell[cell] = next++;
  }
  if (next != static_cast<std::int64_t>(decoded.cloud.size())) {
    return Error{ErrorCode::invalid_argument, "frame " + std::to_string(decoded.frame) +
                                                  ": the original fills " + std::to_string(next) +
                                                  " cells but " + std::to_string(decoded.cloud.size()) +
                                                  " points were decoded: not the same sweep"};
  }
  std::vector<std::int64_t> pairs(original.size(), -1);
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const ProjectedPoint& point = projected[i];
    if (!(point.range_m > 0)) continue;
    const std::size_t cell = image->index(point.cell.row - image->first_row, point.cell.column);
    if (point.range_m == image->range_m[cell]) pairs[i] = std::exchange(point_of_cell[cell], -1);
  }
  return pairs;
}

}  // namespace pointreel
