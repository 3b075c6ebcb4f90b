#include "codec/sweep_preparation.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "base/parallel.h"
#include "codec/field_sections.h"
#include "codec/method.h"
#include "codec/wire.h"
#include "sensor/burst_sort.h"
#include "sensor/point_order.h"

namespace pointreel {
namespace {

constexpr double kLeastDeviationM = 0.05;  // of points on the grid from their rays
// A quarter of the rows a sweep: 28 sweeps share the work that seven would have.
constexpr std::size_t kRefinementTurns = 4;
constexpr double kMostStrays = 0.3;  // of the points; with more, the octree is cheaper

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

Result<void> require_no_more_than_allowed(const PointCloud& sweep, std::uint32_t frame) {
  if (sweep.size() > kMaxPointsPerSweep) {
    return Error{ErrorCode::resource_limit, "frame " + std::to_string(frame) + " has " +
                                                std::to_string(sweep.size()) + " points, more than 2^23"};
  }
  if (sweep.fields.size() > kMostFields) {
    return Error{ErrorCode::resource_limit, "frame " + std::to_string(frame) + " has " +
                                                std::to_string(sweep.fields.size()) + " fields, more than " +
                                                std::to_string(kMostFields)};
  }
  return {};
}

// The range lattice only helps bounds about as fine as itself.
SensorModel useful_part(SensorModel model, double max_error_m) {
  if (model.range_step_m > 3 * max_error_m || model.range_step_m < 1.5 * max_error_m) {
    model.range_step_m = 0;
    model.range_phase.clear();
  }
  return model;
}

}  // namespace

SweepPreparation::SweepPreparation(const StreamHeader& header, const MixtureOptions& options, int threads)
    : max_error_m_(header.max_error_m),
      group_(header.group),
      threads_(threads),
      grid_options_{std::max(kLeastDeviationM, 2 * header.max_error_m), header.max_error_m, threads},
      estimator_(grid_options_, kRefinementTurns),
      // Registration and warping would take longer than all the rest.
      temporal_(options.temporal && options.effort != Effort::fast),
      alignment_(options.register_sweeps) {}

Result<PreparedSweep> SweepPreparation::prepare(PosedSweep sweep) {
  if (const auto valid = require_whole_fields(sweep.cloud); !valid) return valid.error();
  if (const auto valid = require_no_more_than_allowed(sweep.cloud, next_frame_); !valid) return valid.error();
  PreparedSweep prepared;
  prepared.packet.points_in = static_cast<std::uint32_t>(sweep.cloud.size());
  prepared.cloud = finite_part(std::move(sweep.cloud));
  prepared.bursts = undo_sort(prepared.cloud);
  prepared.packet.points_out = static_cast<std::uint32_t>(prepared.cloud.size());
  prepared.packet.non_finite = prepared.packet.points_in - prepared.packet.points_out;

  if (auto gridded = on_grid(prepared.cloud)) {
    prepared.model = model_;
    const auto range_of_cell_m = ranges_by_cell(*gridded);
    const auto register_sweep = [&] {
      if (!temporal_) return;
      prepared.motion =
          alignment_.follow(*model_, gridded->grid, range_of_cell_m, sweep.T_world_sensor, starts_group());
    };
    const auto find_cells = [&] {
      prepared.cells = cells_of_sweep(*model_, *gridded, range_of_cell_m, max_error_m_, threads_);
    };
    run_both(threads_, register_sweep, find_cells);
    estimator_.refine(prepared.cloud, *gridded);
    prepared.gridded = *std::move(gridded);
  }
  name_packet(prepared);
  return prepared;
}

// The next sweep on the grid brings the model.
bool SweepPreparation::starts_group() const {
  return !model_frame_ || model_age_ >= group_;
}

// None when the sweep is not that of a sensor whose grid is known. Within a group the model stays as it was
// sent, while the estimate gets better.
std::optional<GriddedSweep> SweepPreparation::on_grid(const PointCloud& cloud) {
  if (cloud.positions.empty()) return std::nullopt;
  if (starts_group()) {
    if (!estimator_.model()) estimator_.add(cloud);
    if (!estimator_.model()) return std::nullopt;
    model_ = std::make_shared<const SensorModel>(useful_part(*estimator_.model(), max_error_m_));
  }
  auto sweep = project(*model_, cloud, grid_options_, last_grid_ ? &*last_grid_ : nullptr);
  const auto strays = std::count(sweep.cell_of_point.begin(), sweep.cell_of_point.end(), -1);
  if (static_cast<double>(strays) > kMostStrays * static_cast<double>(cloud.size())) return std::nullopt;
  drop_unreachable(cloud, max_error_m_, sweep);
  last_grid_ = sweep.grid;
  return sweep;
}

// Its number, its group and what it refers to.
void SweepPreparation::name_packet(PreparedSweep& prepared) {
  Packet& packet = prepared.packet;
  packet.frame = next_frame_++;
  if (!prepared.model) {
    model_frame_.reset();
  } else if (starts_group()) {
    model_frame_ = packet.frame;
    model_age_ = 0;
  }
  packet.kind = model_frame_ && *model_frame_ != packet.frame ? FrameKind::predicted : FrameKind::key;
  if (packet.kind == FrameKind::key && packet.frame != 0) ++next_group_;
  packet.group = next_group_;
  packet.reference_frame = packet.kind == FrameKind::key ? packet.frame
                           : prepared.motion             ? packet.frame - 1
                                                         : *model_frame_;
  if (!prepared.model) return;
  ++model_age_;
  prepared.is_reference = temporal_ && !starts_group();
}

}  // namespace pointreel
