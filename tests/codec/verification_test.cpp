#include "codec/verification.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "codec/grid_points.h"
#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/ray_table.h"

namespace pointreel {
namespace {

constexpr std::uint32_t kColumns = 400;

struct DecodedSweep {
  SensorModel model;
  PointCloud cloud;
  GriddedSweep sweep;
  std::vector<float> range_of_cell_m;  // as decoded: up to 1.3 bounds off
  std::vector<std::uint32_t> cells;
};

// Points up to 1.5 bounds off the rays of any sensor, near and far.
DecodedSweep any_sweep(std::uint32_t seed, double max_error_m, double nearest_m, double side_m) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  DecodedSweep made;
  SweepGrid grid;
  grid.ticks_per_turn = kColumns;
  for (std::uint32_t c = 0; c < kColumns; ++c) grid.column_tick.push_back(c);
  made.model.ticks_per_turn = kColumns;
  Field ring{"ring", std::vector<std::uint16_t>{}};
  auto& rings = std::get<std::vector<std::uint16_t>>(ring.values);
  for (std::int32_t row = 0; row < 4; ++row) {
    made.model.rows.push_back(
        rounded({uniform(-1, 1), uniform(-0.3, 0.3), uniform(-3, 3), uniform(-side_m, side_m)}));
    made.model.ring_of_row.push_back(row);
    made.model.row_sequence.push_back(static_cast<std::uint16_t>(row));
  }
  const RayTable rays(made.model, grid);
  for (std::size_t row = 0; row < made.model.rows.size(); ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const auto range_m = static_cast<float>(nearest_m * std::exp2(uniform(0, 8)));
      Point3f p = rays.position(row, column, range_m);
      const double off_m = uniform(0, 0.87) * max_error_m;  // along each axis
      p.x += static_cast<float>(uniform(-off_m, off_m));
      p.y += static_cast<float>(uniform(-off_m, off_m));
      p.z += static_cast<float>(uniform(-off_m, off_m));
      made.cloud.positions.push_back(p);
      rings.push_back(static_cast<std::uint16_t>(row));
    }
  }
  made.cloud.fields.push_back(std::move(ring));
  made.sweep = project(made.model, made.cloud, {std::max(0.05, 2 * max_error_m), max_error_m, 1});
  made.range_of_cell_m = ranges_by_cell(made.sweep);
  for (float& range_m : made.range_of_cell_m) {
    if (range_m > 0)
      range_m = std::max(1e-3F, range_m + static_cast<float>(uniform(-1.3, 1.3) * max_error_m));
  }
  made.cells = cells_of_points(made.sweep);
  return made;
}

// Whether each point on the grid misses the bound, from the decoded positions.
std::vector<std::uint32_t> missed_points(const DecodedSweep& made, double max_error_m) {
  const RayTable rays(made.model, made.sweep.grid);
  const std::size_t columns = made.sweep.grid.column_count();
  std::vector<std::uint32_t> missed;
  for (std::size_t i = 0; i < made.cells.size(); ++i) {
    const std::size_t cell = made.cells[i];
    const Point3f decoded = rays.position(cell / columns, cell % columns, made.range_of_cell_m[cell]);
    if (distance_m(decoded, made.cloud.positions[made.sweep.point_of_cell[cell]]) > max_error_m)
      missed.push_back(static_cast<std::uint32_t>(i));
  }
  return missed;
}

RC_GTEST_PROP(Verification, CorrectsThePointsThatMissTheBoundAndNoOther, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  const double max_error_m = *rc::gen::element(0.001, 0.005, 0.02, 0.1, 0.5, 2.0);
  const double nearest_m = *rc::gen::element(0.02, 0.3, 1.0, 4.0);
  const double side_m = *rc::gen::element(0.0, 0.026, 0.3);
  const DecodedSweep made = any_sweep(seed, max_error_m, nearest_m, side_m);
  RC_ASSERT(made.cells.size() > made.cloud.size() / 4);
  std::vector<std::uint32_t> corrected;
  for (const int threads : {1, 2}) {
    corrected.clear();
    for (const Correction& correction : find_corrections(
             made.model, made.cloud, made.sweep, made.range_of_cell_m, made.cells, max_error_m, threads))
      corrected.push_back(correction.index);
    RC_ASSERT(corrected == missed_points(made, max_error_m));
  }
  RC_ASSERT(!corrected.empty());
  RC_ASSERT(corrected.size() < made.cells.size());
}

}  // namespace
}  // namespace pointreel
