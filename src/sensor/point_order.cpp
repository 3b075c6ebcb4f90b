#include "sensor/point_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/first_where.h"
#include "base/parallel.h"
#include "base/simd_loops.h"
#include "sensor/order_moves.h"
#include "sensor/row_walk.h"

namespace pointreel {
namespace {

POINTREEL_SIMD_LOOPS void mark_occupied(const float* range_m, std::size_t cells, std::uint8_t* occupied) {
  for (std::size_t cell = 0; cell < cells; ++cell) occupied[cell] = range_m[cell] > 0 ? 1 : 0;
}

// With more, the order is not kept: a move takes about 20 bits.
std::size_t most_moves(std::size_t points) {
  return points / 50 + 1;
}

// The walk from one cell to the next without a division for each.
struct RowSpan {
  std::uint32_t row = 0, first = 0, end = 0;
  bool holds(std::uint32_t cell) const { return cell >= first && cell < end; }
  static RowSpan of(std::uint32_t cell, std::uint32_t columns) {
    const std::uint32_t row = cell / columns;
    return {row, row * columns, (row + 1) * columns};
  }
};

// The cells of a walk, row by row.
struct RowEnds {
  bool any = false;
  std::uint32_t first_cell = 0, last_cell = 0;
};
struct WalkSummary {
  std::vector<RowEnds> ends;  // per row
  std::size_t same_row = 0;   // steps within a row
  std::size_t falling = 0;    // of those, towards smaller columns
};

WalkSummary summarise(const std::vector<std::uint32_t>& walk, std::uint32_t columns, std::size_t rows) {
  WalkSummary summary{std::vector<RowEnds>(rows), 0, 0};
  RowSpan span;
  std::uint32_t before = 0;
  for (const std::uint32_t cell : walk) {
    if (span.holds(cell)) {
      ++summary.same_row;
      summary.falling += cell < before ? 1 : 0;
    } else {
      if (span.end > 0) summary.ends[span.row].last_cell = before;
      span = RowSpan::of(cell, columns);
      RowEnds& ends = summary.ends[span.row];
      if (!ends.any) ends.first_cell = cell;
      ends.any = true;
    }
    before = cell;
  }
  if (span.end > 0) summary.ends[span.row].last_cell = before;
  return summary;
}

// Where most rows begin: the azimuth between the last and the first point of a row, for as many rows as can
// be. In ticks; for the kind and direction of the grid's order.
std::uint32_t find_seam(const SensorModel& model, const SweepGrid& grid, const std::vector<RowEnds>& ends,
                        const std::vector<float>& range_m) {
  const std::size_t columns = grid.column_count();
  const bool descending = grid.order.descending;
  const auto azimuth_of = [&](std::uint32_t cell) {
    const RowModel& row = model.rows[cell / columns];
    const std::uint32_t of_column = azimuth_of_tick(grid.column_tick[cell % columns], grid.ticks_per_turn) +
                                    row_turn(grid.order.kind, row);
    if (grid.order.kind != OrderKind::row_azimuth) return of_column;
    return of_column + static_cast<std::uint32_t>(turned_by_side(static_cast<float>(row.side_offset_m),
                                                                 range_m[cell] * cosine_of(row)));
  };
  struct Ends {
    std::uint32_t first, last;
  };
  std::vector<Ends> azimuths;
  std::vector<std::uint32_t> seams;  // in ticks
  for (std::uint32_t quarter : {0u, 2u, 1u, 3u})
    seams.push_back(static_cast<std::uint32_t>(std::uint64_t{grid.ticks_per_turn} * quarter / 4));
  for (const RowEnds& row : ends) {
    if (!row.any) continue;
    azimuths.push_back({azimuth_of(row.first_cell), azimuth_of(row.last_cell)});
    const std::uint64_t first = azimuths.back().first;
    seams.push_back(static_cast<std::uint32_t>((first * grid.ticks_per_turn + (1u << 31)) >> 32) %
                    grid.ticks_per_turn);
  }
  std::size_t most = 0;
  std::uint32_t best = 0;
  for (const std::uint32_t tick : seams) {
    const std::uint32_t seam = azimuth_of_tick(tick, grid.ticks_per_turn);
    std::size_t right = 1;
    for (const Ends& row : azimuths) {
      const std::uint32_t from_last = descending ? row.last - seam : seam - row.last;
      const std::uint32_t to_first = descending ? row.last - row.first : row.first - row.last;
      right += from_last > 0 && from_last <= to_first ? 1 : 0;
    }
    if (right > most) {
      most = right;
      best = tick;
    }
  }
  return best;
}

std::vector<std::uint32_t> cells_row_by_row(std::span<const std::uint8_t> occupied,
                                            std::span<const float> range_m, const SensorModel& model,
                                            const SweepGrid& grid, int threads) {
  const std::size_t rows = model.row_sequence.size(), columns = grid.column_count();
  std::vector<std::size_t> first_of_row(rows + 1);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto row = occupied.subspan(model.row_sequence[k] * columns, columns);
    first_of_row[k + 1] = first_of_row[k] + std::accumulate(row.begin(), row.end(), 0u);
  }
  std::vector<std::uint32_t> cells(first_of_row.back());
  const std::size_t pieces = threads > 1 ? std::min(rows, 4 * static_cast<std::size_t>(threads)) : 1;
  parallel_for(pieces, threads, [&](std::size_t piece) {
    RowWalk walk(occupied, range_m, model, grid);
    for (std::size_t k = piece; k < rows; k += pieces)
      walk.list(model.row_sequence[k], cells.data() + first_of_row[k]);
  });
  return cells;
}

}  // namespace

std::vector<float> ranges_by_cell(const GriddedSweep& sweep) {
  std::vector<float> range_m(sweep.point_of_cell.size());
  for (std::size_t cell = 0; cell < range_m.size(); ++cell) {
    const std::uint32_t point = sweep.point_of_cell[cell];
    if (point != kNoPoint) range_m[cell] = sweep.range_m[point];
  }
  return range_m;
}

std::vector<std::uint8_t> occupied_cells(std::span<const float> range_of_cell_m) {
  std::vector<std::uint8_t> occupied(range_of_cell_m.size());
  mark_occupied(range_of_cell_m.data(), occupied.size(), occupied.data());
  return occupied;
}

std::vector<std::uint32_t> cells_in_order(std::span<const std::uint8_t> occupied,
                                          std::span<const float> range_m, const SensorModel& model,
                                          const SweepGrid& grid, int threads) {
  if (is_by_rows(grid.order.kind)) return cells_row_by_row(occupied, range_m, model, grid, threads);
  const auto rows = static_cast<std::uint32_t>(model.rows.size());
  const auto columns = static_cast<std::uint32_t>(grid.column_count());
  std::vector<std::uint32_t> cells(occupied.size() + 1);
  std::size_t count = 0;
  const auto take = [&](std::uint32_t cell) {
    cells[count] = cell;
    count += occupied[cell] != 0 ? 1 : 0;  // branches on single cells would be mispredicted
  };
  if (grid.order.kind == OrderKind::column_major) {
    const auto latest = std::max_element(model.row_delay.begin(), model.row_delay.end());
    const std::uint32_t slots = columns + (latest == model.row_delay.end() ? 0 : *latest);
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      for (const std::uint16_t row : model.row_sequence) {
        const std::uint32_t fired = slot - (model.row_delay.empty() ? 0 : model.row_delay[row]);
        if (fired >= columns) continue;  // or before the first
        take(row * columns + (grid.order.descending ? columns - 1 - fired : fired));
      }
    }
  } else {
    for (std::uint32_t cell = 0; cell < rows * columns; ++cell) take(cell);
  }
  cells.resize(count);
  return cells;
}

std::vector<std::int32_t> firing_places_of(const SensorModel& model, const SweepGrid& grid,
                                           std::span<const std::uint32_t> cells) {
  std::vector<std::int32_t> places(cells.size(), -1);
  if (grid.order.kind != OrderKind::column_major) return places;
  const std::size_t rows = model.rows.size();
  const std::size_t columns = grid.column_count();
  std::vector<std::size_t> rank(rows);
  for (std::size_t k = 0; k < rows; ++k) rank[model.row_sequence[k]] = k;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t row = cells[i] / columns;
    const std::size_t column = cells[i] % columns;
    const std::size_t fired = grid.order.descending ? columns - 1 - column : column;
    const std::size_t slot = fired + (model.row_delay.empty() ? 0 : model.row_delay[row]);
    places[i] = static_cast<std::int32_t>(slot * rows + rank[row]);
  }
  return places;
}

std::vector<std::uint32_t> cells_of_points(const GriddedSweep& sweep) {
  const std::int32_t* cell = sweep.cell_of_point.data();
  const std::size_t points = sweep.cell_of_point.size();
  const auto is_stray = [=](std::size_t i) { return static_cast<int>(cell[i] < 0); };
  std::vector<std::uint32_t> cells;
  cells.reserve(points);
  for (std::size_t first = 0; first < points;) {  // from one stray to the next
    const std::size_t end = first_where(first, points, is_stray);
    cells.insert(cells.end(), cell + first, cell + end);
    first = end + 1;
  }
  return cells;
}

PointOrder find_order(const SensorModel& model, const GriddedSweep& sweep,
                      std::optional<bool> firing_descending) {
  const auto walk = cells_of_points(sweep);
  if (walk.empty()) return {};
  SweepGrid grid = sweep.grid;
  const std::size_t columns = grid.column_count();
  const auto range_m = ranges_by_cell(sweep);
  const auto occupied = occupied_cells(range_m);
  std::vector<OrderKind> kinds;
  WalkSummary summary;
  if (firing_descending) {
    kinds = {OrderKind::column_major};
    grid.order.descending = *firing_descending;
  } else {
    summary = summarise(walk, static_cast<std::uint32_t>(columns), model.rows.size());
    if (summary.same_row * 2 < walk.size()) return {};
    kinds = {OrderKind::row_azimuth, OrderKind::row_major, OrderKind::row_column};
    grid.order.descending = summary.falling * 2 > summary.same_row;
  }
  PointOrder best;
  std::size_t fewest = most_moves(walk.size()) + 1;
  for (const OrderKind kind : kinds) {
    grid.order.kind = kind;
    if (kind != OrderKind::column_major) grid.order.seam_tick = find_seam(model, grid, summary.ends, range_m);
    const auto expected = cells_in_order(occupied, range_m, model, grid);
    const std::size_t moved = count_moves(expected, walk, occupied.size());
    if (moved >= fewest) continue;
    fewest = moved;
    best = grid.order;
    if (moved < walk.size() / 500) break;
  }
  return best;
}

std::vector<OrderMove> settle_order(const SensorModel& model, std::span<const std::uint8_t> occupied,
                                    std::span<const float> range_m, std::span<const std::uint32_t> walk,
                                    GriddedSweep& sweep, int threads) {
  PointOrder& order = sweep.grid.order;
  if (order.kind == OrderKind::none) return {};
  const auto moves_now = [&] {
    return find_moves(cells_in_order(occupied, range_m, model, sweep.grid, threads), walk, occupied.size());
  };
  auto moves = moves_now();
  constexpr std::size_t kFew = 16;
  if (is_by_rows(order.kind) && moves.size() > kFew) {
    const PointOrder found = find_order(model, sweep, {});
    if (found.kind != OrderKind::none && found != order) {
      const PointOrder before = std::exchange(order, found);
      auto other = moves_now();
      if (other.size() < moves.size())
        moves = std::move(other);
      else
        order = before;
    }
  }
  if (moves.size() <= most_moves(walk.size())) return moves;
  order = {};
  return {};
}

}  // namespace pointreel
