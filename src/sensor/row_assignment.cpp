#include "sensor/row_assignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <unordered_map>

#include "base/parallel.h"
#include "base/simd_loops.h"
#include "sensor/row_runs.h"
#include "sensor/row_values.h"

namespace pointreel {
namespace {

// Rows from the lowest to the highest, for a binary search by z at a given rho.
class NearestRow {
 public:
  explicit NearestRow(const SensorModel& model) : model_(model) {}

  // Rows cross near the sensor, where their offsets differ: a few around the found one are compared.
  std::int16_t operator()(double rho_m, double z_m) const {
    const auto count = static_cast<int>(model_.rows.size());
    int above = 0;  // the first row that the point is not below
    for (int step = count; step > 0;) {
      const int half = step / 2;
      const int middle = above + half;
      if (height_above_row_m(model_.rows[static_cast<std::size_t>(middle)], rho_m, z_m) < 0) {
        above = middle + 1;
        step -= half + 1;
      } else {
        step = half;
      }
    }
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int row = std::max(0, above - kReach); row < std::min(count, above + kReach); ++row) {
      const RowModel& candidate = model_.rows[static_cast<std::size_t>(row)];
      const double distance = std::fabs(height_above_row_m(candidate, rho_m, z_m));
      if (distance < least) {
        least = distance;
        best = row;
      }
    }
    return static_cast<std::int16_t>(best);
  }

 private:
  static constexpr int kReach = 3;
  const SensorModel& model_;
};

std::vector<std::int16_t> rows_by_ring(const SensorModel& model, const std::vector<std::int32_t>& rings,
                                       const PolarPoints& polar) {
  std::unordered_map<std::int32_t, std::int16_t> row_of_ring;
  for (std::size_t row = 0; row < model.ring_of_row.size(); ++row)
    row_of_ring.emplace(model.ring_of_row[row], static_cast<std::int16_t>(row));
  std::vector<std::int16_t> rows(polar.size(), kNoRow);
  std::int32_t last_ring = 0;
  std::int16_t last_row = kNoRow;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    if (rings[i] != last_ring || last_row == kNoRow) {
      const auto found = row_of_ring.find(rings[i]);
      last_row = found == row_of_ring.end() ? kNoRow : found->second;
      last_ring = rings[i];
    }
    rows[i] = last_row;
  }
  return rows;
}

// How far the points of a run are off a row, in the median (compensated sweeps are bent both ways, so medians
// still tell).
class RunMisfit {
 public:
  RunMisfit(const SensorModel& model, const PolarPoints& polar, std::size_t first, std::size_t last)
      : model_(model), polar_(polar) {
    for (std::size_t s = 0; s < kSamples; ++s) {
      const std::size_t i = first + (last - first) * s / kSamples;
      if (polar.has_ray(i)) samples_[count_++] = i;
    }
  }

  double operator()(std::size_t row) const {
    if (count_ == 0) return std::numeric_limits<double>::infinity();
    std::array<float, kSamples> elevations{};
    for (std::size_t s = 0; s < count_; ++s) {
      const std::size_t i = samples_[s];
      elevations[s] = static_cast<float>(
          height_above_row_m(model_.rows[row], polar_.rho_m[i], polar_.z_m[i]) / polar_.rho_m[i]);
    }
    float* const middle = elevations.data() + count_ / 2;
    std::nth_element(elevations.data(), middle, elevations.data() + count_);
    return std::fabs(static_cast<double>(*middle));
  }

 private:
  static constexpr std::size_t kSamples = 48;

  const SensorModel& model_;
  const PolarPoints& polar_;
  std::array<std::size_t, kSamples> samples_{};
  std::size_t count_ = 0;
};

// The row that a run's points lie neither above nor below, and how far off it is.
struct FoundRow {
  std::size_t row;
  double misfit;
};

// From a row that may be it to those beside it, as long as they fit better.
FoundRow nearest_to_run(const RunMisfit& misfit_of, std::size_t first_guess, std::size_t rows) {
  FoundRow best{first_guess, misfit_of(first_guess)};
  for (const bool up : {true, false}) {
    const std::size_t from = best.row;
    for (;;) {
      if (up ? best.row + 1 >= rows : best.row == 0) break;
      const std::size_t next = up ? best.row + 1 : best.row - 1;
      const double misfit = misfit_of(next);
      if (!(misfit < best.misfit)) break;
      best = {next, misfit};
    }
    if (best.row != from) break;
  }
  return best;
}

FoundRow best_of_all(const RunMisfit& misfit_of, std::size_t rows) {
  FoundRow best{0, misfit_of(0)};
  for (std::size_t row = 1; row < rows; ++row) {
    const double misfit = misfit_of(row);
    if (misfit < best.misfit) best = {row, misfit};
  }
  return best;
}

// Half the median gap between rows: runs that miss every row by more are no rows.
double run_tolerance(const SensorModel& model) {
  std::vector<double> gaps;
  for (std::size_t row = 1; row < model.rows.size(); ++row)
    gaps.push_back(std::fabs(model.rows[row - 1].slope - model.rows[row].slope));
  if (gaps.empty()) return 0.1;
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2] / 2;
}

// Runs may be missing, cut in two or made of a few points that jitter around the seam: each finds its own
// row, short ones point by point. Empty when the cloud is not made of runs.
std::vector<std::int16_t> rows_by_runs(const SensorModel& model, const PolarPoints& polar,
                                       const NearestRow& nearest, int threads) {
  constexpr std::size_t kShortRun = 24;
  const RowRuns runs = split_into_runs(polar, threads);
  if (runs.runs() > 4 * model.rows.size() + 16) return {};
  if (runs.runs() * 4 < model.rows.size()) return {};  // whole turns of all rows: column by column
  const double tolerance = run_tolerance(model);
  std::vector<std::int16_t> rows(polar.size(), kNoRow);
  const std::size_t count = model.rows.size();
  std::size_t fitting = 0;
  std::size_t row_before = 0;
  for (std::size_t run = 0; run < runs.runs(); ++run) {
    const std::size_t first = runs.first[run];
    const std::size_t last = runs.end(run, polar.size());
    FoundRow found{0, std::numeric_limits<double>::infinity()};
    if (last - first > kShortRun) {
      const RunMisfit misfit_of(model, polar, first, last);
      found = nearest_to_run(misfit_of, std::min(row_before + 1, count - 1), count);
      if (found.misfit >= tolerance) found = best_of_all(misfit_of, count);
    }
    if (found.misfit < tolerance) {
      row_before = found.row;
      fitting += last - first;
      const auto row = static_cast<std::int16_t>(found.row);
      for (std::size_t i = first; i < last; ++i) rows[i] = polar.rho_m[i] > 0 ? row : kNoRow;
    } else {
      for (std::size_t i = first; i < last; ++i) {
        if (polar.has_ray(i)) rows[i] = nearest(polar.rho_m[i], polar.z_m[i]);
      }
    }
  }
  if (fitting * 2 < polar.size()) return {};
  return rows;
}

// Hardly any point is far from its row, but for those without one.
class FarFromRow {
 public:
  static constexpr double kFarM = 0.02;
  static constexpr std::size_t kBlock = 256;
  static_assert(kPiecePoints % kBlock == 0);

  explicit FarFromRow(const SensorModel& model)
      : slopes_(model, &RowModel::slope), offsets_m_(model, &RowModel::offset_m) {}

  // Of `count` points, at most kBlock.
  POINTREEL_SIMD_LOOPS bool any(const PolarPoints& polar, const std::vector<std::int16_t>& rows,
                                std::size_t first, std::size_t count) const {
    float slope[kBlock], offset_m[kBlock];
    const RowBlock block(&rows[first], count);
    block.spread(slopes_, slope);
    block.spread(offsets_m_, offset_m);
    const float* rho_m = &polar.rho_m[first];
    const float* z_m = &polar.z_m[first];
    int far = 0;
    for (std::size_t k = 0; k < count; ++k)
      far |= std::fabs(z_m[k] - slope[k] * rho_m[k] - offset_m[k]) > static_cast<float>(kFarM) ? 1 : 0;
    return far != 0;
  }

 private:
  RowValues slopes_, offsets_m_;
};

}  // namespace

const Field* find_ring_field(const PointCloud& cloud) {
  for (const char* name : {"ring", "Ring", "channel", "Channel", "laser_id", "laser", "laser_number", "line",
                           "row", "beam", "scan_line", "ring_id", "ring_index"}) {
    if (const Field* field = cloud.find_field(name)) return field;
  }
  return nullptr;
}

std::vector<std::int32_t> ring_values(const PointCloud& cloud) {
  const Field* field = find_ring_field(cloud);
  if (field == nullptr || field->size() != cloud.size()) return {};
  std::vector<std::int32_t> rings(cloud.size());
  const auto convert = [&](const auto& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = static_cast<double>(values[i]);
      if (!(std::fabs(value) < 1e9) || value != std::floor(value)) return false;
      rings[i] = static_cast<std::int32_t>(value);
    }
    return true;
  };
  if (!std::visit(convert, field->values)) return {};
  return rings;
}

std::vector<std::int16_t> assign_rows(const SensorModel& model, const PointCloud& cloud,
                                      const PolarPoints& polar, int threads) {
  if (model.rows.empty()) {
    std::vector<std::int16_t> none(polar.size(), kNoRow);
    return none;
  }
  if (!model.ring_of_row.empty()) {
    const auto rings = ring_values(cloud);
    if (!rings.empty()) return rows_by_ring(model, rings, polar);
  }
  auto rows = rows_by_runs(model, polar, NearestRow(model), threads);
  if (!rows.empty() || polar.size() == 0) return rows;
  return nearest_rows(model, polar, threads);
}

std::vector<std::int16_t> nearest_rows(const SensorModel& model, const PolarPoints& polar, int threads) {
  const NearestRow nearest(model);
  std::vector<std::int16_t> rows(polar.size(), kNoRow);
  for_each_piece(polar.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (polar.has_ray(i)) rows[i] = nearest(polar.rho_m[i], polar.z_m[i]);
    }
  });
  return rows;
}

void settle_rows(const SensorModel& model, const PolarPoints& polar, int threads,
                 std::vector<std::int16_t>& rows) {
  if (!model.ring_of_row.empty() || model.rows.empty()) return;
  const NearestRow nearest(model);
  const FarFromRow far_from_row(model);
  const auto settle_block = [&](std::size_t first, std::size_t last) {
    if (!far_from_row.any(polar, rows, first, last - first)) return;
    for (std::size_t i = first; i < last; ++i) {
      if (rows[i] < 0 || !polar.has_ray(i)) continue;
      const RowModel& row = model.rows[static_cast<std::size_t>(rows[i])];
      if (std::fabs(height_above_row_m(row, polar.rho_m[i], polar.z_m[i])) > FarFromRow::kFarM)
        rows[i] = nearest(polar.rho_m[i], polar.z_m[i]);
    }
  };
  for_each_piece(rows.size(), threads, [&](std::size_t, std::size_t piece_first, std::size_t last) {
    for (std::size_t first = piece_first; first < last; first += FarFromRow::kBlock)
      settle_block(first, std::min(last, first + FarFromRow::kBlock));
  });
}

}  // namespace pointreel
