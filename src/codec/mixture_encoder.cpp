// The sensor's grid, methods `mixture` and `planes`: find the sensor -> project -> register, find cells ->
// find planes -> predict and code -> verify -> fields -> packet.
#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "codec/field_sections.h"
#include "codec/gridded_geometry.h"
#include "codec/method.h"
#include "codec/mixture_payload.h"
#include "codec/sections.h"
#include "codec/sweep_alignment.h"
#include "codec/wire.h"
#include "scatter/scattered_points.h"
#include "sensor/burst_sort.h"
#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/sensor_coding.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

// The sweep without its non-finite points.
PointCloud finite_part(PointCloud sweep) {
  if (sweep.count_non_finite() == 0) return sweep;
  std::vector<bool> keep(sweep.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = is_finite(sweep.positions[i]);
  const auto filter = [&](auto& values) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      if (keep[i]) values[next++] = values[i];
    }
    values.resize(next);
  };
  filter(sweep.positions);
  for (Field& field : sweep.fields) std::visit(filter, field.values);
  return sweep;
}

class MixtureEncoder final : public Encoder::Implementation {
 public:
  MixtureEncoder(const StreamHeader& header, const MixtureOptions& options, int threads)
      : header_(header),
        fields_(options.fields),
        threads_(threads),
        grid_options_{std::max(kLeastDeviationM, 2 * header.max_error_m), header.max_error_m, threads},
        estimator_(grid_options_, kRefinementTurns),
        // Registration and warping would take longer than all the rest.
        temporal_(options.temporal && options.effort != Effort::fast),
        // Sparing the rest takes balanced 0.05 to 0.16 % more bits.
        alignment_(options.register_sweeps,
                   options.effort == Effort::max ? RegistrationSettings{} : kQuickRegistration) {}

  const StreamHeader& header() const override { return header_; }

  Result<std::vector<Packet>> encode(PointCloud sweep, const std::optional<Pose>& T_world_sensor) override {
    if (sweep.size() > kMaxPointsPerSweep) {
      return Error{ErrorCode::resource_limit, "frame " + std::to_string(next_frame_) + " has " +
                                                  std::to_string(sweep.size()) + " points, more than 2^23"};
    }
    if (sweep.fields.size() > kMostFields) {
      return Error{ErrorCode::resource_limit, "frame " + std::to_string(next_frame_) + " has " +
                                                  std::to_string(sweep.fields.size()) +
                                                  " fields, more than " + std::to_string(kMostFields)};
    }
    Packet packet;
    packet.frame = next_frame_;
    packet.points_in = static_cast<std::uint32_t>(sweep.size());
    PointCloud cloud = finite_part(std::move(sweep));
    const auto bursts = undo_sort(cloud);
    packet.points_out = static_cast<std::uint32_t>(cloud.size());
    packet.non_finite = packet.points_in - packet.points_out;

    ByteWriter writer;
    EncodedGeometry encoded;
    std::uint32_t reference_frame = packet.frame;
    if (auto gridded = on_grid(cloud)) {
      std::optional<Pose> T_ref_cur;
      std::optional<SweepCells> cells;
      const auto range_of_cell_m = ranges_by_cell(*gridded);
      const auto register_sweep = [&] {
        if (temporal_)
          T_ref_cur =
              alignment_.follow(*model_, gridded->grid, range_of_cell_m, T_world_sensor, starts_group());
      };
      const auto find_cells = [&] {
        cells = cells_of_sweep(*model_, *gridded, range_of_cell_m, header_.max_error_m, threads_);
      };
      run_both(threads_, register_sweep, find_cells);
      estimator_.refine(cloud, *gridded);
      if (starts_group()) {
        put_model(writer, packet.statistics);
      } else {
        writer.put(T_ref_cur ? SweepCoding::predicted : SweepCoding::gridded);
      }
      reference_frame = T_ref_cur ? packet.frame - 1 : *model_frame_;
      const auto prediction =
          T_ref_cur ? std::optional(Prediction{last_image_.reference, last_image_.planes, *T_ref_cur})
                    : std::nullopt;
      encoded = encode_gridded(geometry_setting(header_, *model_, threads_, warp_memory_), cloud,
                               *std::move(gridded), *std::move(cells), bursts,
                               prediction ? &*prediction : nullptr, writer, packet.statistics);
      ++model_age_;
      if (temporal_ && !starts_group()) {
        last_image_ = std::move(encoded.image);
      }
    } else {
      encoded = encode_scattered_sweep(cloud, writer, packet.statistics);
      model_frame_.reset();
    }
    encode_fields(fields_, cloud, encoded.output_order, encoded.geometry, threads_, writer,
                  packet.statistics);

    packet.kind = model_frame_ && *model_frame_ != packet.frame ? FrameKind::predicted : FrameKind::key;
    if (packet.kind == FrameKind::key && packet.frame != 0) ++next_group_;
    packet.group = next_group_;
    packet.reference_frame = packet.kind == FrameKind::key ? packet.frame : reference_frame;
    packet.payload = writer.take();
    ++next_frame_;
    return std::vector<Packet>{std::move(packet)};
  }

  Result<std::vector<Packet>> finish() override { return std::vector<Packet>{}; }

 private:
  static constexpr double kLeastDeviationM = 0.05;  // of points on the grid from their rays
  // A quarter of the rows a sweep: 28 sweeps share the work that seven would have.
  static constexpr std::size_t kRefinementTurns = 4;
  static constexpr double kMostStrays = 0.3;  // of the points; with more, the octree is cheaper

  // The next gridded sweep brings the model.
  bool starts_group() const { return !model_frame_ || model_age_ >= header_.group; }

  // None when the sweep is not that of a sensor whose grid is known. Within a group the model stays as it was
  // sent, while the estimate gets better.
  std::optional<GriddedSweep> on_grid(const PointCloud& cloud) {
    if (cloud.positions.empty()) return std::nullopt;
    if (starts_group()) {
      if (!estimator_.model()) estimator_.add(cloud);
      if (!estimator_.model()) return std::nullopt;
      model_ = useful_part(*estimator_.model());
    }
    auto sweep = project(*model_, cloud, grid_options_, last_grid_ ? &*last_grid_ : nullptr);
    const auto strays = std::count(sweep.cell_of_point.begin(), sweep.cell_of_point.end(), -1);
    if (static_cast<double>(strays) > kMostStrays * static_cast<double>(cloud.size())) return std::nullopt;
    drop_unreachable(cloud, header_.max_error_m, sweep);
    last_grid_ = sweep.grid;
    return sweep;
  }

  // The range lattice only helps bounds about as fine as itself.
  SensorModel useful_part(SensorModel model) const {
    if (model.range_step_m > 3 * header_.max_error_m || model.range_step_m < 1.5 * header_.max_error_m) {
      model.range_step_m = 0;
      model.range_phase.clear();
    }
    return model;
  }

  void put_model(ByteWriter& writer, FrameStatistics& statistics) {
    const auto bytes = encode_sensor_model(*model_);
    writer.put(SweepCoding::gridded_model);
    put_section(writer, bytes);
    statistics.model_bits += bits_of(bytes.size());
    model_frame_ = next_frame_;
    model_age_ = 0;
  }

  EncodedGeometry encode_scattered_sweep(const PointCloud& cloud, ByteWriter& writer,
                                         FrameStatistics& statistics) const {
    writer.put(SweepCoding::scattered);
    auto points = encode_scattered(cloud.positions, header_.max_error_m);
    put_section(writer, points.bytes);
    statistics.scattered_bits += bits_of(points.bytes.size());
    EncodedGeometry encoded;
    encoded.output_order = std::move(points.order);
    encoded.geometry.cell_of_point.assign(cloud.size(), -1);
    encoded.geometry.range_m.assign(cloud.size(), 0);
    encoded.geometry.order_kept = false;
    return encoded;
  }

  StreamHeader header_;
  FieldSelection fields_;
  int threads_;
  GridOptions grid_options_;
  SensorEstimator estimator_;
  std::optional<SensorModel> model_;          // of this group
  std::optional<std::uint32_t> model_frame_;  // the frame that brought it
  std::optional<SweepGrid> last_grid_;        // of the sweep before
  bool temporal_;
  SweepAlignment alignment_;
  CodedImage last_image_;
  WarpMemory warp_memory_;
  int model_age_ = 0;  // sweeps coded with it
  std::uint32_t next_frame_ = 0;
  std::uint32_t next_group_ = 0;
};

}  // namespace

Result<std::unique_ptr<Encoder::Implementation>> make_mixture_encoder(const EncoderOptions& options,
                                                                      const Runtime& runtime) {
  StreamHeader header;
  header.method = options.method;
  header.max_error_m = options.mixture.max_error_m;
  header.group = options.mixture.group;
  header.effort = options.mixture.effort;
  header.planes.grid = PlaneGrid::sensor;
  if (const auto valid = validate(header); !valid) return valid.error();
  for (const FieldStep& field : options.mixture.fields.named) {
    if (!(field.step >= 0 && field.step <= 1e300)) {
      return Error{ErrorCode::invalid_argument, "fields: the step of " + field.name + " must be 0 or more"};
    }
  }
  return std::unique_ptr<Encoder::Implementation>(
      std::make_unique<MixtureEncoder>(header, options.mixture, resolve_threads(runtime.threads)));
}

}  // namespace pointreel
