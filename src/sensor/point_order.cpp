#include "sensor/point_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "sensor/order_moves.h"

namespace pointreel {
namespace {

constexpr double kTurn = 2 * kPi;

double turned(double azimuth_rad) {
  while (azimuth_rad < 0) azimuth_rad += kTurn;
  while (azimuth_rad >= kTurn) azimuth_rad -= kTurn;
  return azimuth_rad >= 0 ? azimuth_rad : 0;  // not a number, which no sort can bear
}

// Appends the occupied cells of one row, once around from the seam.
class RowWalk {
 public:
  RowWalk(std::span<const std::uint8_t> occupied, std::span<const float> range_m, const SensorModel& model,
          const SweepGrid& grid)
      : occupied_(occupied), range_m_(range_m), model_(model), grid_(grid) {
    const double tick_rad = kTurn / grid.ticks_per_turn;
    seam_rad_ = grid.order.seam_tick * tick_rad;
    for (const std::uint32_t tick : grid.column_tick)
      azimuth_rad_.push_back(tick % grid.ticks_per_turn * tick_rad);
  }

  void append(std::uint32_t row, std::vector<std::uint32_t>& cells) {
    const RowModel& laser = model_.rows[row];
    const std::size_t columns = azimuth_rad_.size();
    const bool by_azimuth = grid_.order.kind == OrderKind::row_azimuth;
    const double cosine = 1 / std::sqrt(1 + laser.slope * laser.slope);
    keyed_.clear();
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t cell = row * columns + c;
      if (occupied_[cell] == 0) continue;
      double azimuth = azimuth_rad_[c] + laser.azimuth_rad - seam_rad_;
      if (by_azimuth) {
        azimuth += static_cast<double>(
            fast_atan2(static_cast<float>(laser.side_offset_m), static_cast<float>(range_m_[cell] * cosine)));
      }
      azimuth = turned(azimuth);
      keyed_.push_back(
          {grid_.order.descending ? kTurn - azimuth : azimuth, static_cast<std::uint32_t>(cell)});
    }
    const auto earlier = [](const Keyed& a, const Keyed& b) {
      return a.key != b.key ? a.key < b.key : a.cell < b.cell;
    };
    // Two ascending runs, but for a few neighbours.
    if (grid_.order.descending) std::reverse(keyed_.begin(), keyed_.end());
    const auto least = std::min_element(keyed_.begin(), keyed_.end(), earlier);
    std::rotate(keyed_.begin(), least, keyed_.end());
    sort_nearly_sorted(earlier);
    for (const Keyed& keyed : keyed_) cells.push_back(keyed.cell);
  }

 private:
  struct Keyed {
    double key;
    std::uint32_t cell;
  };
  // By insertion while that is cheap, which hostile ranges may not let it be.
  template <class Earlier>
  void sort_nearly_sorted(const Earlier& earlier) {
    std::size_t work = 8 * keyed_.size();
    for (std::size_t i = 1; i < keyed_.size(); ++i) {
      const Keyed inserted = keyed_[i];
      std::size_t place = i;
      for (; place > 0 && earlier(inserted, keyed_[place - 1]); --place) {
        keyed_[place] = keyed_[place - 1];
        if (--work == 0) {
          keyed_[place - 1] = inserted;
          std::sort(keyed_.begin(), keyed_.end(), earlier);
          return;
        }
      }
      keyed_[place] = inserted;
    }
  }

  std::span<const std::uint8_t> occupied_;
  std::span<const float> range_m_;
  const SensorModel& model_;
  const SweepGrid& grid_;
  double seam_rad_ = 0;
  std::vector<double> azimuth_rad_;
  std::vector<Keyed> keyed_;
};

struct CellImage {
  std::vector<std::uint8_t> occupied;
  std::vector<float> range_m;
};

CellImage image_of(const SensorModel& model, const GriddedSweep& sweep) {
  const std::size_t cells = model.rows.size() * sweep.grid.column_count();
  CellImage image{std::vector<std::uint8_t>(cells, 0), std::vector<float>(cells, 0)};
  for (std::size_t i = 0; i < sweep.cell_of_point.size(); ++i) {
    if (sweep.cell_of_point[i] < 0) continue;
    const auto cell = static_cast<std::size_t>(sweep.cell_of_point[i]);
    image.occupied[cell] = 1;
    image.range_m[cell] = sweep.range_m[i];
  }
  return image;
}

// Where most rows begin: the azimuth (of column and row) between the last and the first point of a row, for
// as many rows as can be. In ticks.
std::uint32_t find_seam(const SensorModel& model, const SweepGrid& grid,
                        const std::vector<std::uint32_t>& walk, bool descending) {
  const std::size_t columns = grid.column_count();
  const double tick_rad = kTurn / grid.ticks_per_turn;
  struct Ends {
    bool any = false;
    double first = 0, last = 0;
  };
  std::vector<Ends> ends(model.rows.size());
  for (const std::uint32_t cell : walk) {
    Ends& row = ends[cell / columns];
    const double azimuth = turned(grid.column_tick[cell % columns] % grid.ticks_per_turn * tick_rad +
                                  model.rows[cell / columns].azimuth_rad);
    if (!row.any) row.first = azimuth;
    row.any = true;
    row.last = azimuth;
  }
  std::vector<double> seams = {0, kTurn / 2, kTurn / 4, kTurn * 3 / 4};
  for (const Ends& row : ends) {
    if (row.any) seams.push_back(row.first);
  }
  std::size_t most = 0;
  double best = 0;
  for (const double seam : seams) {
    std::size_t right = 1;
    for (const Ends& row : ends) {
      if (!row.any) continue;
      const double from_last = turned(descending ? row.last - seam : seam - row.last);
      const double to_first = turned(descending ? row.last - row.first : row.first - row.last);
      right += from_last > 0 && from_last <= to_first ? 1 : 0;
    }
    if (right > most) {
      most = right;
      best = seam;
    }
  }
  return static_cast<std::uint32_t>(best / tick_rad + 0.5) % grid.ticks_per_turn;
}

}  // namespace

std::vector<std::uint32_t> cells_in_order(std::span<const std::uint8_t> occupied,
                                          std::span<const float> range_m, const SensorModel& model,
                                          const SweepGrid& grid) {
  const auto rows = static_cast<std::uint32_t>(model.rows.size());
  const auto columns = static_cast<std::uint32_t>(grid.column_count());
  std::vector<std::uint32_t> cells;
  if (grid.order.kind == OrderKind::column_major) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t column = grid.order.descending ? columns - 1 - i : i;
      for (const std::uint16_t row : model.row_sequence) {
        const std::uint32_t cell = row * columns + column;
        if (occupied[cell] != 0) cells.push_back(cell);
      }
    }
  } else if (grid.order.kind == OrderKind::none) {
    for (std::uint32_t cell = 0; cell < rows * columns; ++cell) {
      if (occupied[cell] != 0) cells.push_back(cell);
    }
  } else {
    RowWalk walk(occupied, range_m, model, grid);
    for (const std::uint16_t row : model.row_sequence) walk.append(row, cells);
  }
  return cells;
}

std::vector<std::uint32_t> cells_of_points(const GriddedSweep& sweep) {
  std::vector<std::uint32_t> cells;
  cells.reserve(sweep.cell_of_point.size());
  for (const std::int32_t cell : sweep.cell_of_point) {
    if (cell >= 0) cells.push_back(static_cast<std::uint32_t>(cell));
  }
  return cells;
}

PointOrder find_order(const SensorModel& model, const GriddedSweep& sweep,
                      std::optional<bool> firing_descending) {
  const auto walk = cells_of_points(sweep);
  if (walk.empty()) return {};
  SweepGrid grid = sweep.grid;
  const std::size_t columns = grid.column_count();
  const CellImage image = image_of(model, sweep);
  std::vector<OrderKind> kinds;
  if (firing_descending) {
    kinds = {OrderKind::column_major};
    grid.order.descending = *firing_descending;
  } else {
    std::size_t same_row = 0;
    std::size_t falling = 0;
    for (std::size_t i = 1; i < walk.size(); ++i) {
      if (walk[i] / columns != walk[i - 1] / columns) continue;
      ++same_row;
      if (walk[i] < walk[i - 1]) ++falling;
    }
    if (same_row * 2 < walk.size()) return {};
    kinds = {OrderKind::row_azimuth, OrderKind::row_major};
    grid.order.descending = falling * 2 > same_row;
    grid.order.seam_tick = find_seam(model, grid, walk, grid.order.descending);
  }
  PointOrder best;
  std::size_t fewest = walk.size() / 50 + 2;
  std::vector<std::uint32_t> place(image.occupied.size(), 0);
  std::vector<std::uint32_t> keys(walk.size());
  for (const OrderKind kind : kinds) {
    grid.order.kind = kind;
    const auto expected = cells_in_order(image.occupied, image.range_m, model, grid);
    for (std::size_t i = 0; i < expected.size(); ++i) place[expected[i]] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < walk.size(); ++i) keys[i] = place[walk[i]];
    const std::size_t moved = order_breakers(keys).size();
    if (moved >= fewest) continue;
    fewest = moved;
    best = grid.order;
    if (moved < walk.size() / 500) break;
  }
  return best;
}

}  // namespace pointreel
