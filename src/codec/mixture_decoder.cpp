// The sensor's grid, the way back: sensor model -> planes -> cells and ranges -> points in order ->
// corrections, strays -> fields.
#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "codec/field_sections.h"
#include "codec/grid_points.h"
#include "codec/gridded_geometry.h"
#include "codec/method.h"
#include "codec/mixture_payload.h"
#include "codec/packet_groups.h"
#include "codec/point_matching.h"
#include "codec/sections.h"
#include "codec/sweep_planes.h"
#include "codec/wire.h"
#include "scatter/scattered_points.h"
#include "sensor/burst_sort.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

// Decodes groups, one after the other: a key frame forgets all before it.
class GroupDecoder {
 public:
  explicit GroupDecoder(const StreamHeader& header) : header_(header) {}

  // All packets of one group, or what is left of it.
  void decode(std::span<const Packet> packets, int threads, std::span<Result<DecodedSweep>> sweeps) {
    if (header_.effort == Effort::fast) {
      decode_side_by_side(packets, threads, sweeps);
    } else {
      decode_in_turn(packets, threads, sweeps);
    }
  }

  Result<SweepPlanes> decode_planes(const Packet& packet, int threads) {
    ByteReader reader(packet.payload);
    const auto coding = coding_of(packet, planes_frame_, reader);
    if (!coding) return coding.error();
    if (*coding == SweepCoding::scattered) return SweepPlanes{packet.frame, {}, {}};
    auto planes = decode_gridded_planes(geometry_setting(header_, model_, threads, warp_memory_),
                                        *coding == SweepCoding::predicted ? &last_planes_ : nullptr, reader);
    if (!planes) return planes.error();
    last_planes_ = *std::move(planes);
    planes_frame_ = packet.frame;
    const CodingGrid coding_grid(model_, last_planes_.grid);
    return sweep_planes_of(packet.frame, rays_of(model_, last_planes_.grid, coding_grid), last_planes_.tiles);
  }

 private:
  struct BegunSweep {
    SweepCoding coding;
    std::optional<DecodedCells> cells;  // of a sweep on the grid
    ByteReader reader;                  // of what is left of the payload
  };

  // Of effort fast: no sweep needs another one, all need the sensor model that came with the first.
  void decode_side_by_side(std::span<const Packet> packets, int threads,
                           std::span<Result<DecodedSweep>> sweeps) {
    std::vector<ByteReader> readers;
    std::vector<Result<SweepCoding>> codings;
    for (const Packet& packet : packets) {
      readers.emplace_back(packet.payload);
      codings.push_back(coding_of(packet, reference_frame_, readers.back()));
    }
    const int threads_each = std::max(1, threads / static_cast<int>(packets.size()));
    parallel_for(packets.size(), threads, [&](std::size_t i) {
      CodedImage image;  // of no use to any other
      WarpMemory unused;
      finish(packets[i],
             codings[i] ? begin(*codings[i], readers[i],
                                geometry_setting(header_, model_, threads_each, unused), image)
                        : codings[i].error(),
             threads_each, sweeps[i]);
    });
  }

  // With several threads the points of a sweep are decoded while the cells of the next one are.
  void decode_in_turn(std::span<const Packet> packets, int threads, std::span<Result<DecodedSweep>> sweeps) {
    std::optional<Result<BegunSweep>> last;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      bool spoilt = false;
      const std::function<void()> finish_last = [&] {
        if (last)
          spoilt = !finish(packets[i - 1], *std::exchange(last, std::nullopt), threads, sweeps[i - 1]);
      };
      if (threads == 1) finish_last();
      ByteReader reader(packets[i].payload);
      const auto coding = coding_of(packets[i], reference_frame_, reader);
      const auto setting =
          geometry_setting(header_, model_, threads, warp_memory_, BesideTasks(&finish_last, 1));
      auto begun = coding ? begin(*coding, reader, setting, last_image_) : Result<BegunSweep>(coding.error());
      if (begun && begun->cells) remember_reference(packets[i]);
      finish_last();  // where there was no image to decode
      if (spoilt && (!coding || *coding == SweepCoding::predicted)) {
        forget_reference();
        if (coding) begun = reference_is_missing(packets[i]);
      }
      last = std::move(begun);
    }
    if (last && !finish(packets.back(), *std::move(last), threads, sweeps.back())) forget_reference();
  }

  // `image`: of the reference, then of this sweep. The setting's `beside` are not called where there is none.
  static Result<BegunSweep> begin(SweepCoding coding, ByteReader reader, const GeometrySetting& setting,
                                  CodedImage& image) {
    if (coding == SweepCoding::scattered) return BegunSweep{coding, {}, reader};
    auto cells = decode_cells(setting, coding == SweepCoding::predicted ? &image : nullptr, reader, image);
    if (!cells) return cells.error();
    return BegunSweep{coding, *std::move(cells), reader};
  }

  void remember_reference(const Packet& packet) {
    reference_frame_ = packet.frame;
    if (header_.method == Method::planes) {
      last_planes_ = {last_image_.reference.grid, last_image_.planes};
      planes_frame_ = packet.frame;
    }
  }

  // False when a sweep whose cells were decoded has damaged points: it is no reference then.
  bool finish(const Packet& packet, Result<BegunSweep> begun, int threads,
              Result<DecodedSweep>& sweep) const {
    const bool has_cells = static_cast<bool>(begun);
    sweep = has_cells ? finished(packet, *std::move(begun), threads) : begun.error();
    if (sweep) return true;
    sweep = in_frame(packet, sweep.error());
    return !has_cells;
  }

  Result<DecodedSweep> finished(const Packet& packet, BegunSweep begun, int threads) const {
    ByteReader& reader = begun.reader;
    auto geometry = !begun.cells ? decode_scattered_sweep(packet, reader)
                                 : decode_points({model_, header_.max_error_m, threads}, packet.points_out,
                                                 *begun.cells, reader);
    if (!geometry) return geometry.error();
    const std::size_t field_bytes = ByteReader(reader).rest().size();  // a copy: rest() takes them
    DecodedSweep sweep;
    sweep.frame = packet.frame;
    sweep.cloud.positions = std::move(geometry->positions);
    if (sweep.cloud.count_non_finite() > 0)
      return Error{ErrorCode::corrupt, "it holds a position that is not finite"};
    const auto find_cells = [&] {
      return begun.cells
                 ? point_cells(begun.cells->coding, geometry->points, begun.cells->range_of_cell_m, threads)
                 : points_without_cells(sweep.cloud.size());
    };
    auto fields = decode_fields(find_cells, threads, reader);
    if (!fields) return fields.error();
    if (!reader.rest().empty()) return Error{ErrorCode::corrupt, "bytes follow its fields"};
    sweep.cloud.fields = *std::move(fields);
    if (!geometry->bursts.empty()) redo_sort(geometry->bursts, sweep.cloud);
    sweep.order_kept = geometry->order_kept;
    sweep.temporal = begun.coding == SweepCoding::predicted;
    sweep.field_bytes = field_bytes;
    return sweep;
  }

  void forget_reference() {
    reference_frame_.reset();
    planes_frame_.reset();
  }
  static Error reference_is_missing(const Packet& packet) {
    return {ErrorCode::corrupt,
            "its reference frame " + std::to_string(packet.reference_frame) + " was not decoded before it"};
  }

  // How the packet is coded, once its model is known. `reference_frame`: whose ranges, or planes, are known.
  Result<SweepCoding> coding_of(const Packet& packet, std::optional<std::uint32_t>& reference_frame,
                                ByteReader& reader) {
    if (packet.kind == FrameKind::key) {
      model_frame_.reset();
      forget_reference();
    }
    if (packet.points_out > kMaxPointsPerSweep) {
      return Error{ErrorCode::resource_limit, "it claims " + std::to_string(packet.points_out) + " points"};
    }
    const auto coding = reader.get<SweepCoding>();
    if (!reader.ok()) return Error{ErrorCode::truncated, "its payload is empty"};
    if (coding > SweepCoding::predicted)
      return Error{ErrorCode::unsupported, "it is coded in an unknown way"};
    const bool needs_frame = coding == SweepCoding::gridded || coding == SweepCoding::predicted;
    if (needs_frame != (packet.kind == FrameKind::predicted)) {
      return Error{ErrorCode::corrupt, "its kind and its coding contradict each other"};
    }
    if (coding == SweepCoding::predicted && header_.effort == Effort::fast)
      return Error{ErrorCode::corrupt, "effort fast predicts no sweep from another"};
    if (coding == SweepCoding::gridded_model) {
      auto model = decode_sensor_model(get_section(reader));
      if (!model) return model.error();
      model_ = *std::move(model);
      model_frame_ = packet.frame;
    } else if (needs_frame &&
               (coding == SweepCoding::gridded ? model_frame_ : reference_frame) != packet.reference_frame) {
      return reference_is_missing(packet);
    }
    return coding;
  }

  Result<DecodedGeometry> decode_scattered_sweep(const Packet& packet, ByteReader& reader) const {
    auto points = decode_scattered(get_section(reader), header_.max_error_m, packet.points_out);
    if (!points) return points.error();
    if (points->size() != packet.points_out) {
      return Error{ErrorCode::corrupt, "it decodes to " + std::to_string(points->size()) +
                                           " points instead of " + std::to_string(packet.points_out)};
    }
    DecodedGeometry geometry;
    geometry.order_kept = points->empty();
    geometry.positions = *std::move(points);
    return geometry;
  }

  StreamHeader header_;
  SensorModel model_;
  std::optional<std::uint32_t> model_frame_;  // the frame that brought it
  CodedImage last_image_;                     // of the last sweep on the grid
  std::optional<std::uint32_t> reference_frame_;
  GriddedPlanes last_planes_;  // of the last sweep on the grid, if only those were decoded
  std::optional<std::uint32_t> planes_frame_;
  WarpMemory warp_memory_;
};

class MixtureDecoder final : public Decoder::Implementation {
 public:
  MixtureDecoder(const StreamHeader& header, int threads)
      : header_(header), threads_(threads), decoders_(1, GroupDecoder(header)) {}

  std::vector<Result<DecodedSweep>> decode(std::span<const Packet> packets) override {
    return decode_by_groups(packets, threads_,
                            [this](std::span<const Packet> groups) { return decode_groups(groups); });
  }

  Result<SweepPlanes> decode_planes(const Packet& packet) override {
    if (header_.method != Method::planes) return Decoder::Implementation::decode_planes(packet);
    return decoders_.front().decode_planes(packet, threads_);
  }

 private:
  // Side by side; where there are fewer than threads, these share the work within each.
  std::vector<Result<DecodedSweep>> decode_groups(std::span<const Packet> packets) {
    std::vector<Result<DecodedSweep>> sweeps(packets.size(), DecodedSweep{});
    const auto firsts = firsts_of_groups(packets);
    const std::size_t groups = firsts.size() - 1;
    const int threads_each = std::max(1, threads_ / static_cast<int>(groups));
    if (decoders_.size() < groups) decoders_.resize(groups, GroupDecoder(header_));
    parallel_for(groups, threads_, [&](std::size_t group) {
      const std::size_t count = firsts[group + 1] - firsts[group];
      decoders_[group].decode(packets.subspan(firsts[group], count), threads_each,
                              std::span(sweeps).subspan(firsts[group], count));
    });
    // The last group may go on in the next call.
    if (groups > 1) std::swap(decoders_.front(), decoders_[groups - 1]);
    return sweeps;
  }

  StreamHeader header_;
  int threads_;
  std::vector<GroupDecoder> decoders_;  // the first one goes on with the last group
};

}  // namespace

Result<std::unique_ptr<Decoder::Implementation>> make_mixture_decoder(const StreamHeader& header,
                                                                      const Runtime& runtime) {
  if (const auto valid = validate(header); !valid) return valid.error();
  return std::unique_ptr<Decoder::Implementation>(
      std::make_unique<MixtureDecoder>(header, resolve_threads(runtime.threads)));
}

Result<std::vector<std::int64_t>> pair_mixture_points(const StreamHeader& header, const PointCloud& original,
                                                      const DecodedSweep& decoded) {
  if (const auto valid = validate(header); !valid) return valid.error();
  const std::size_t finite = original.size() - original.count_non_finite();
  if (finite != decoded.cloud.size()) {
    return Error{ErrorCode::invalid_argument,
                 "frame " + std::to_string(decoded.frame) + ": the original has " + std::to_string(finite) +
                     " finite points but " + std::to_string(decoded.cloud.size()) +
                     " were decoded: not the same sweep"};
  }
  if (!decoded.order_kept)
    return match_points(original.positions, decoded.cloud.positions, header.max_error_m);
  std::vector<std::int64_t> pairs(original.size(), -1);
  std::int64_t next = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (is_finite(original.positions[i])) pairs[i] = next++;
  }
  return pairs;
}

}  // namespace pointreel
