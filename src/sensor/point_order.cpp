#include "sensor/point_order.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

namespace pointreel {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::uint32_t turned(std::int64_t value, std::int64_t turn) {
  const std::int64_t rest = value % turn;
  return static_cast<std::uint32_t>(rest < 0 ? rest + turn : rest);
}

std::int64_t row_turn_ticks(const RowModel& row, std::uint32_t ticks_per_turn) {
  const double ticks = row.azimuth_rad / kTurn * ticks_per_turn;
  return static_cast<std::int64_t>(ticks + (ticks < 0 ? -0.5 : 0.5));
}

std::vector<std::uint16_t> place_in_sequence(const SensorModel& model) {
  std::vector<std::uint16_t> place(model.rows.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[model.row_sequence[i]] = static_cast<std::uint16_t>(i);
  return place;
}

// Indices (into keys) that no longest strictly increasing subsequence keeps.
std::vector<std::size_t> order_breakers(const std::vector<std::int64_t>& keys) {
  std::vector<std::size_t> tails;  // of the best subsequence of each length
  std::vector<std::size_t> before(keys.size(), keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    auto place = tails.end();
    if (!tails.empty() && keys[tails.back()] >= keys[i]) {
      place = std::lower_bound(tails.begin(), tails.end(), keys[i],
                               [&](std::size_t tail, std::int64_t key) { return keys[tail] < key; });
    }
    if (place != tails.begin()) before[i] = *(place - 1);
    if (place == tails.end()) {
      tails.push_back(i);
    } else {
      *place = i;
    }
  }
  std::vector<std::uint8_t> kept(keys.size(), 0);
  for (std::size_t i = tails.empty() ? keys.size() : tails.back(); i < keys.size(); i = before[i])
    kept[i] = 1;
  std::vector<std::size_t> breakers;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (kept[i] == 0) breakers.push_back(i);
  }
  return breakers;
}

// The points on the grid, in the order of the cloud.
struct Walk {
  std::vector<std::uint32_t> point, row, column;
};

Walk walk_of(const GriddedSweep& sweep) {
  Walk walk;
  const auto columns = static_cast<std::uint32_t>(std::max<std::size_t>(1, sweep.grid.column_count()));
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const auto cell = static_cast<std::uint32_t>(sweep.cell_of_point[i]);
    walk.point.push_back(static_cast<std::uint32_t>(i));
    walk.row.push_back(cell / columns);
    walk.column.push_back(cell % columns);
  }
  return walk;
}

// Columns from a row's last point (exclusive) to its first: where the row may start. Rows without points have
// none; rows whose points go around more than once start at their first point.
struct Ends {
  bool any = false;
  std::uint32_t first = 0, last = 0;
};

void choose_start_columns(const SensorModel& model, const std::vector<Ends>& ends, SweepGrid& grid) {
  const auto columns = static_cast<std::int64_t>(grid.column_count());
  const bool descending = grid.order.descending;
  // Columns that the row leaves out between its last point and `column`, in its own direction.
  const auto steps_from_last = [&](const Ends& row, std::uint32_t column) {
    const std::int64_t steps = static_cast<std::int64_t>(column) - static_cast<std::int64_t>(row.last);
    return turned(descending ? -steps : steps, columns);
  };
  const auto may_start = [&](const Ends& row, std::uint32_t column) {
    const std::uint32_t gap = steps_from_last(row, row.first);
    const std::uint32_t steps = steps_from_last(row, column);
    return gap == 0 ? column == row.first : steps > 0 && steps <= gap;
  };
  std::vector<std::uint32_t> seams = {0, grid.ticks_per_turn / 2, grid.ticks_per_turn / 4,
                                      grid.ticks_per_turn / 4 * 3};
  for (std::size_t r = 0; r < ends.size(); ++r) {
    if (!ends[r].any) continue;
    const std::int64_t tick =
        grid.column_tick[ends[r].first] + row_turn_ticks(model.rows[r], grid.ticks_per_turn);
    seams.push_back(turned(tick, grid.ticks_per_turn));
  }
  std::size_t most = 0;
  std::uint32_t best_seam = 0;
  for (const std::uint32_t seam : seams) {
    grid.order.seam_tick = seam;
    const auto starts = seam_columns(model, grid);
    std::size_t right = 1;
    for (std::size_t r = 0; r < ends.size(); ++r)
      right += ends[r].any && may_start(ends[r], starts[r]) ? 1 : 0;
    if (right > most) {
      most = right;
      best_seam = seam;
    }
  }
  grid.order.seam_tick = best_seam;
  grid.order.start_column = seam_columns(model, grid);
  for (std::size_t r = 0; r < ends.size(); ++r) {
    if (ends[r].any && !may_start(ends[r], grid.order.start_column[r]))
      grid.order.start_column[r] = ends[r].first;
  }
}

std::vector<Ends> row_ends(const Walk& walk, std::size_t rows) {
  std::vector<Ends> ends(rows);
  for (std::size_t i = 0; i < walk.point.size(); ++i) {
    Ends& row = ends[walk.row[i]];
    if (!row.any) row.first = walk.column[i];
    row.any = true;
    row.last = walk.column[i];
  }
  return ends;
}

}  // namespace

std::vector<std::uint32_t> seam_columns(const SensorModel& model, const SweepGrid& grid) {
  std::vector<std::uint32_t> starts(model.rows.size(), 0);
  if (grid.column_tick.empty()) return starts;
  const auto columns = static_cast<std::uint32_t>(grid.column_count());
  for (std::size_t r = 0; r < starts.size(); ++r) {
    const std::int64_t seam =
        static_cast<std::int64_t>(grid.order.seam_tick) - row_turn_ticks(model.rows[r], grid.ticks_per_turn);
    const std::uint32_t tick = turned(seam, grid.ticks_per_turn);
    if (grid.order.descending) {
      const auto above = std::upper_bound(grid.column_tick.begin(), grid.column_tick.end(), tick);
      const auto index = static_cast<std::uint32_t>(above - grid.column_tick.begin());
      starts[r] = index == 0 ? columns - 1 : index - 1;
    } else {
      const auto found = std::lower_bound(grid.column_tick.begin(), grid.column_tick.end(), tick);
      const auto index = static_cast<std::uint32_t>(found - grid.column_tick.begin());
      starts[r] = index == columns ? 0 : index;
    }
  }
  return starts;
}

void find_order(const SensorModel& model, bool in_firing_order, bool descending, GriddedSweep& sweep) {
  SweepGrid& grid = sweep.grid;
  const Walk walk = walk_of(sweep);
  const std::size_t count = walk.point.size();
  const auto columns = static_cast<std::int64_t>(grid.column_count());
  const auto place = place_in_sequence(model);
  grid.order = {};
  std::vector<std::int64_t> keys(count);
  if (in_firing_order) {
    grid.order.kind = OrderKind::column_major;
    grid.order.descending = descending;
    const auto rows = static_cast<std::int64_t>(model.rows.size());
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t column = walk.column[i];
      keys[i] = (descending ? columns - 1 - column : column) * rows + place[walk.row[i]];
    }
  } else {
    std::size_t same_row = 0;
    std::size_t falling = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if (walk.row[i] != walk.row[i - 1]) continue;
      ++same_row;
      if (walk.column[i] < walk.column[i - 1]) ++falling;
    }
    if (count == 0 || same_row * 2 < count) return;
    grid.order.kind = OrderKind::row_major;
    grid.order.descending = falling * 2 > same_row;
    const auto ends = row_ends(walk, model.rows.size());
    choose_start_columns(model, ends, grid);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t steps =
          static_cast<std::int64_t>(walk.column[i]) - grid.order.start_column[walk.row[i]];
      keys[i] = place[walk.row[i]] * columns + turned(grid.order.descending ? -steps : steps, columns);
    }
  }
  const auto breakers = order_breakers(keys);
  // The order is not worth more strays than these.
  if (breakers.size() > count / 100 + 2) {
    grid.order = {};
    return;
  }
  for (const std::size_t i : breakers) {
    const std::uint32_t point = walk.point[i];
    sweep.cell_of_point[point] = -1;
    sweep.range_m[point] = 0;
    sweep.deviation_m[point] = 0;
    sweep.stray_reason[point] = StrayReason::out_of_order;
  }
}

}  // namespace pointreel
