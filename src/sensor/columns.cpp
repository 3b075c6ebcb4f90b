#include "sensor/columns.h"

#include <algorithm>
#include <cmath>

#include "base/first_where.h"
#include "base/parallel.h"
#include "base/simd_loops.h"
#include "base/trigonometry.h"
#include "sensor/row_values.h"
#include "sensor/side_turn.h"

namespace pointreel {
namespace {

// A column that fewer points use is none: they are sent apart, which is cheaper, unless all columns are thin.
std::uint32_t least_support(std::size_t points, std::size_t places) {
  return static_cast<std::uint32_t>(
      std::min<std::size_t>(3, 1 + points / std::max<std::size_t>(1, 16 * places)));
}

std::size_t most_columns(std::size_t rows) {
  return std::min(kMaxColumns, kMaxCells / std::max<std::size_t>(rows, 1));
}

// Points between the columns go to a neighbour that is near enough: close to the sensor, where the file's
// rounding turns them by more than half a tick.
void take_in_neighbours(const PolarPoints& polar, const std::vector<std::int16_t>& rows,
                        std::span<const float> azimuth_rad, double near_m, SweepColumns& columns) {
  if (columns.tick.empty()) return;
  const double ticks_per_rad = columns.ticks_per_turn / kTurn;
  const std::int16_t* row = rows.data();
  std::int32_t* column_of_point = columns.column_of_point.data();
  const auto is_between = [=](std::size_t i) {
    return static_cast<int>(row[i] >= 0) & static_cast<int>(column_of_point[i] < 0);
  };
  for_each_where(rows.size(), is_between, [&](std::size_t i) {
    const double tick = static_cast<double>(azimuth_rad[i]) * ticks_per_rad;
    const auto above = std::lower_bound(columns.tick.begin(), columns.tick.end(), tick,
                                        [](std::uint32_t a, double b) { return a < b; });
    const auto next = static_cast<std::size_t>(above - columns.tick.begin());
    double nearest_m = near_m;
    for (const std::size_t c :
         {next == columns.tick.size() ? 0 : next, next == 0 ? columns.tick.size() - 1 : next - 1}) {
      const double away_m = std::fabs(std::remainder((tick - columns.tick[c]) / ticks_per_rad, kTurn)) *
                            static_cast<double>(polar.rho_m[i]);
      if (away_m >= nearest_m) continue;
      nearest_m = away_m;
      column_of_point[i] = static_cast<std::int32_t>(c);
    }
  });
}

POINTREEL_SIMD_LOOPS SweepColumns columns_on_lattice(const SensorModel& model,
                                                     const std::vector<std::int16_t>& rows,
                                                     std::span<const float> azimuth_rad, bool unwrapped) {
  const std::uint32_t turn = model.ticks_per_turn;
  const auto turn_ticks = static_cast<std::int32_t>(turn);
  const std::uint32_t end = unwrapped ? 2 * turn : turn;
  const auto ticks_per_rad = static_cast<float>(turn / kTurn);
  SweepColumns columns{turn, {}, RawVector<std::int32_t>(rows.size())};
  const std::int16_t* row = rows.data();
  std::int32_t* tick_of_point = columns.column_of_point.data();
  for (std::size_t i = 0; i < rows.size(); ++i) {  // becomes SIMD code
    const float azimuth = azimuth_rad[i] > 0 ? azimuth_rad[i] : 0.0F;
    const auto tick = static_cast<std::int32_t>(azimuth * ticks_per_rad + 0.5F);
    const std::int32_t within = tick - (tick >= static_cast<std::int32_t>(end) ? turn_ticks : 0);
    tick_of_point[i] = row[i] < 0 ? -1 : within;
  }
  std::vector<std::uint32_t> support_from_none(end + 1, 0);  // the first counts points without a row
  for (std::size_t i = 0; i < rows.size(); ++i)
    ++support_from_none[static_cast<std::size_t>(tick_of_point[i] + 1)];
  const std::span<const std::uint32_t> support = std::span(support_from_none).subspan(1);
  std::size_t points = 0;
  std::size_t used = 0;
  for (const std::uint32_t count : support) {
    points += count;
    used += count > 0 ? 1 : 0;
  }
  const std::uint32_t least = least_support(points, used);
  std::vector<std::int32_t> column_from_none(end + 1, -1);
  for (std::uint32_t tick = 0; tick < end; ++tick) {
    if (support[tick] < least || columns.tick.size() >= most_columns(model.rows.size())) continue;
    if (columns.tick.empty() && tick >= turn) continue;
    column_from_none[tick + 1] = static_cast<std::int32_t>(columns.tick.size());
    columns.tick.push_back(tick);
  }
  const std::int32_t* column_of_tick = column_from_none.data() + 1;
  for (std::size_t i = 0; i < rows.size(); ++i) tick_of_point[i] = column_of_tick[tick_of_point[i]];
  return columns;
}

// How finely the columns' azimuths are sent: half a step may cost a tenth of the bound at twice the mean
// range.
std::uint32_t free_ticks_per_turn(const PolarPoints& polar, double max_error_m) {
  double sum = 0;
  for (const float rho : polar.rho_m) sum += static_cast<double>(rho);
  const double far_m =
      std::clamp(2 * sum / static_cast<double>(std::max<std::size_t>(1, polar.size())), 1.0, 200.0);
  std::uint32_t ticks = 1u << 13;
  while (ticks < kMaxTicksPerTurn && kTurn / ticks * far_m > max_error_m / 5) ticks *= 2;
  return ticks;
}

// Half the usual distance of two neighbours in a row, estimated from the fullest row.
double column_step_rad(const std::vector<std::int16_t>& rows, std::span<const float> azimuth_rad,
                       std::size_t row_count) {
  std::vector<std::size_t> points(row_count, 0);
  for (const std::int16_t row : rows) {
    if (row >= 0) ++points[static_cast<std::size_t>(row)];
  }
  const auto fullest = std::max_element(points.begin(), points.end());
  if (fullest == points.end() || *fullest < 3) return 0;
  const auto row = static_cast<std::int16_t>(fullest - points.begin());
  std::vector<double> sorted;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] == row) sorted.push_back(azimuth_rad[i]);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> steps;
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    if (sorted[k] - sorted[k - 1] > 1e-5) steps.push_back(sorted[k] - sorted[k - 1]);
  }
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

// Columns on no lattice: clusters of the azimuths of all rows.
SweepColumns free_columns(const SensorModel& model, const PolarPoints& polar,
                          const std::vector<std::int16_t>& rows, std::span<const float> azimuth_rad,
                          bool unwrapped, double max_error_m) {
  constexpr double kBinsPerStep = 12;
  constexpr std::size_t kMostBins = std::size_t{1} << 21;
  SweepColumns columns{free_ticks_per_turn(polar, max_error_m), {}, RawVector<std::int32_t>(rows.size(), -1)};
  const double step = column_step_rad(rows, azimuth_rad, model.rows.size());
  if (step <= 0) return columns;
  const double span = unwrapped ? 2 * kTurn : kTurn;
  const auto bins = static_cast<std::size_t>(
      std::min(static_cast<double>(kMostBins), std::ceil(span / step * kBinsPerStep)));
  struct Bin {
    std::uint32_t points = 0;
    double weight = 0, sum = 0;
  };
  std::vector<Bin> histogram(bins);
  std::vector<std::uint32_t> bin_of_point(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    const double azimuth = azimuth_rad[i];
    const auto b = std::min(
        bins - 1, static_cast<std::size_t>(std::max(0.0, azimuth) / span * static_cast<double>(bins)));
    const double weight = std::min(static_cast<double>(polar.rho_m[i]), 20.0);
    bin_of_point[i] = static_cast<std::uint32_t>(b);
    ++histogram[b].points;
    histogram[b].weight += weight;
    histogram[b].sum +=
        weight * (azimuth - (static_cast<double>(b) + 0.5) * span / static_cast<double>(bins));
  }
  // Starts where there is nothing, so that no cluster is cut at the end of the turn.
  std::size_t start = 0;
  while (start < bins && histogram[start].points != 0) ++start;
  if (start == bins) start = 0;
  struct Cluster {
    double azimuth;
    std::size_t first, count;  // bins, from `first` cyclically
  };
  std::vector<Cluster> clusters;
  const auto points = static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [](std::int16_t row) { return row >= 0; }));
  const std::uint32_t least = least_support(points, static_cast<std::size_t>(kTurn / step));
  const auto close = [&](std::size_t first, std::size_t last) {  // offsets from start
    // Longer than a step: cut at the emptiest bins.
    std::size_t from = first;
    while (from < last) {
      std::size_t to = last;
      if (static_cast<double>(last - from) > 1.5 * kBinsPerStep) {
        to = from + static_cast<std::size_t>(kBinsPerStep / 2);
        for (std::size_t b = to; b < std::min(last, from + static_cast<std::size_t>(1.5 * kBinsPerStep));
             ++b) {
          if (histogram[(start + b) % bins].points < histogram[(start + to) % bins].points) to = b;
        }
      }
      std::uint32_t support = 0;
      double weight = 0;
      double sum = 0;
      for (std::size_t b = from; b < to; ++b) {
        const Bin& bin = histogram[(start + b) % bins];
        support += bin.points;
        weight += bin.weight;
        sum +=
            bin.sum + bin.weight * (static_cast<double>(start + b) + 0.5) * span / static_cast<double>(bins);
      }
      if (support >= least && weight > 0) {
        double azimuth = sum / weight;
        if (azimuth >= span) azimuth -= span;
        clusters.push_back({azimuth, (start + from) % bins, to - from});
      }
      from = to;
    }
  };
  std::size_t first = 0;
  std::size_t empty = 2;
  for (std::size_t b = 0; b < bins; ++b) {
    if (histogram[(start + b) % bins].points == 0) {
      if (++empty == 2) close(first, b - 1);
      continue;
    }
    if (empty >= 2) first = b;
    empty = 0;
  }
  if (empty < 2) close(first, bins);
  std::sort(clusters.begin(), clusters.end(),
            [](const Cluster& a, const Cluster& b) { return a.azimuth < b.azimuth; });
  std::vector<std::int32_t> column_of_bin(bins, -1);
  const std::uint32_t end = (unwrapped ? 2 : 1) * columns.ticks_per_turn;
  for (const Cluster& cluster : clusters) {
    auto tick =
        static_cast<std::uint32_t>(std::max(0.0, cluster.azimuth) / kTurn * columns.ticks_per_turn + 0.5);
    if (tick >= end) tick = end - 1;
    if (columns.tick.empty() ? tick >= columns.ticks_per_turn : false) continue;
    if (columns.tick.empty() || tick > columns.tick.back()) {
      if (columns.tick.size() >= most_columns(model.rows.size())) break;
      columns.tick.push_back(tick);
    }
    for (std::size_t b = 0; b < cluster.count; ++b)
      column_of_bin[(cluster.first + b) % bins] = static_cast<std::int32_t>(columns.tick.size()) - 1;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] >= 0) columns.column_of_point[i] = column_of_bin[bin_of_point[i]];
  }
  return columns;
}

// Those of the points in [from, last).
POINTREEL_SIMD_LOOPS void fill_azimuths(const SensorModel& model, const PolarPoints& polar,
                                        const std::vector<std::int16_t>& rows, std::size_t from,
                                        std::size_t last, RawVector<float>& azimuths) {
  constexpr auto kTurnF = static_cast<float>(kTurn);
  constexpr std::size_t kBlock = 256;
  float alpha_rad[kBlock], side_m[kBlock], side_rad[kBlock];
  const RowValues alphas_rad(model, &RowModel::azimuth_rad), sides_m(model, &RowModel::side_offset_m);
  for (std::size_t first = from; first < last; first += kBlock) {
    const std::size_t count = std::min(kBlock, last - first);
    const RowBlock block(&rows[first], count);
    block.spread(alphas_rad, alpha_rad);
    block.spread(sides_m, side_m);
    const float* azimuth_rad = &polar.azimuth_rad[first];
    const float* rho_m = &polar.rho_m[first];
    float* column_rad = &azimuths[first];
    side_turns(side_m, rho_m, count, side_rad);
    for (std::size_t k = 0; k < count; ++k) {
      float azimuth = azimuth_rad[k] - alpha_rad[k] - side_rad[k];
      azimuth += azimuth < 0 ? kTurnF : 0.0F;
      azimuth += azimuth < 0 ? kTurnF : 0.0F;
      azimuth -= azimuth >= kTurnF ? kTurnF : 0.0F;
      column_rad[k] = azimuth < kTurnF ? azimuth : 0.0F;
    }
  }
}

}  // namespace

RawVector<float> column_azimuths(const SensorModel& model, const PolarPoints& polar,
                                 const std::vector<std::int16_t>& rows, int threads) {
  RawVector<float> azimuths(polar.size());
  for_each_piece(polar.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    fill_azimuths(model, polar, rows, first, last, azimuths);
  });
  return azimuths;
}

SweepColumns find_columns(const SensorModel& model, const PolarPoints& polar,
                          const std::vector<std::int16_t>& rows, std::span<const float> azimuth_rad,
                          bool unwrapped, const GridOptions& options) {
  SweepColumns columns = model.ticks_per_turn > 0
                             ? columns_on_lattice(model, rows, azimuth_rad, unwrapped)
                             : free_columns(model, polar, rows, azimuth_rad, unwrapped, options.max_error_m);
  take_in_neighbours(polar, rows, azimuth_rad, std::min(options.max_deviation_m, options.max_error_m / 4),
                     columns);
  return columns;
}

}  // namespace pointreel
