#include "sensor/sensor_estimator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/trigonometry.h"
#include "sensor/blind_twist.h"
#include "sensor/columns.h"
#include "sensor/diagnosis.h"
#include "sensor/firing_order.h"
#include "sensor/firing_sequence.h"
#include "sensor/polar_points.h"
#include "sensor/row_assignment.h"
#include "sensor/row_evidence.h"
#include "sensor/row_fit.h"
#include "sensor/tick_lattice.h"

namespace pointreel {
namespace {

// Rows of a compensated sweep are this sharp once the motion is put back, or there was none.
constexpr double kCompensatedScatterM = 3e-3;
// A model that does no better than this is none.
constexpr double kMostStrays = 0.3;       // share of the points that have a direction
constexpr double kLeastOccupancy = 0.05;  // share of the cells

// One sweep on its way to a model.
class ModelFit {
 public:
  ModelFit(const PolarPoints& polar, const RowEvidence& evidence, int threads)
      : polar_(polar), threads_(threads) {
    std::vector<RowFit> fits(evidence.points.size());
    parallel_for(fits.size(), threads, [&](std::size_t g) { fits[g] = fit_row(polar, evidence.points[g]); });
    std::vector<std::size_t> group_of_row;  // top to bottom
    for (std::size_t g = 0; g < fits.size(); ++g) {
      if (fits[g].usable) group_of_row.push_back(g);
    }
    std::stable_sort(group_of_row.begin(), group_of_row.end(),
                     [&](std::size_t a, std::size_t b) { return fits[a].slope > fits[b].slope; });
    row_of_point_.assign(polar.size(), kNoRow);
    const bool has_rings = !evidence.ring.empty();
    for (const std::size_t g : group_of_row) {
      // A row that was cut in two, or found twice.
      const bool again = !has_rings && !model_.rows.empty() && is_same(model_.rows.back(), fits[g]);
      if (!again) {
        model_.rows.push_back({fits[g].slope, fits[g].offset_m, 0, 0});
        if (has_rings) model_.ring_of_row.push_back(evidence.ring[g]);
      }
      for (const std::uint32_t i : evidence.points[g])
        row_of_point_[i] = static_cast<std::int16_t>(model_.rows.size() - 1);
    }
    settle_rows(model_, polar, threads, row_of_point_);
    points_.resize(model_.rows.size());
    for (std::size_t i = 0; i < polar.size(); ++i) {
      if (row_of_point_[i] >= 0)
        points_[static_cast<std::size_t>(row_of_point_[i])].push_back(static_cast<std::uint32_t>(i));
    }
    // A row whose points all belong to others is none.
    for (std::size_t r = points_.size(); r-- > 0;) {
      if (points_[r].empty()) drop_row(r);
    }
  }

  SensorModel fit() {
    if (model_.rows.empty()) return model_;
    const bool in_firing_order = find_firing_order(azimuths(), row_of_point_).has_value();
    model_.ticks_per_turn = find_ticks_per_turn(polar_, points_);
    if (model_.ticks_per_turn > 0) {
      fit_lattice(in_firing_order);
    } else {
      fit_columns(in_firing_order);
    }
    // A common turn of all rows means nothing; the median row is put at 0.
    centre_azimuths();
    for (RowModel& row : model_.rows) row = rounded(row);
    find_row_sequence(in_firing_order);
    return model_;
  }

 private:
  static bool is_same(const RowModel& row, const RowFit& fit) {
    constexpr double kNearM = 10;
    constexpr double kFarM = 50;
    constexpr double kSameM = 0.005;
    const double slope = row.slope - fit.slope;
    const double offset_m = row.offset_m - fit.offset_m;
    return std::fabs(slope * kNearM + offset_m) < kSameM && std::fabs(slope * kFarM + offset_m) < 5 * kSameM;
  }

  void drop_row(std::size_t row) {
    const auto at = static_cast<std::ptrdiff_t>(row);
    model_.rows.erase(model_.rows.begin() + at);
    points_.erase(points_.begin() + at);
    if (!model_.ring_of_row.empty()) model_.ring_of_row.erase(model_.ring_of_row.begin() + at);
    for (std::int16_t& other : row_of_point_) {
      if (other > static_cast<std::int16_t>(row)) --other;
    }
  }

  RawVector<float> azimuths() const { return column_azimuths(model_, polar_, row_of_point_, threads_); }

  void fit_lattice(bool in_firing_order) {
    const std::size_t rows = model_.rows.size();
    const double tick_rad = kTurn / model_.ticks_per_turn;
    parallel_for(rows, threads_, [&](std::size_t r) {
      const RowAzimuth fit = fit_row_azimuth(polar_, points_[r], model_.ticks_per_turn);
      model_.rows[r].side_offset_m = fit.side_offset_m;
      model_.rows[r].azimuth_rad = fit.phase_rad;
    });
    std::uint32_t most_ticks = model_.ticks_per_turn / 8;  // rows look at most 45 deg ahead
    if (in_firing_order) {
      constexpr std::uint32_t kMostStaggerTicks = 24;  // more, and the azimuths fit no column any more
      const auto leads = row_leads_rad(azimuths(), row_of_point_, rows);
      for (std::size_t r = 0; r < rows; ++r)
        model_.rows[r].azimuth_rad += std::nearbyint((leads[r] - leads[0]) / tick_rad) * tick_rad;
      most_ticks = kMostStaggerTicks;
    }
    const auto azimuth = azimuths();
    std::vector<std::vector<std::uint32_t>> ticks(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      for (const std::uint32_t i : points_[r])
        ticks[r].push_back(static_cast<std::uint32_t>(static_cast<double>(azimuth[i]) / tick_rad + 0.5) %
                           model_.ticks_per_turn);
    }
    const auto shifts = align_rows(ticks, model_.ticks_per_turn, most_ticks);
    for (std::size_t r = 0; r < rows; ++r) model_.rows[r].azimuth_rad -= shifts[r] * tick_rad;
  }

  // No lattice: columns and rows in turns, each from the other's azimuths.
  void fit_columns(bool in_firing_order) {
    constexpr int kRounds = 4;
    constexpr double kMostSideM = 0.15;
    const std::size_t rows = model_.rows.size();
    if (in_firing_order) {
      const auto leads = row_leads_rad(azimuths(), row_of_point_, rows);
      for (std::size_t r = 0; r < rows; ++r) model_.rows[r].azimuth_rad = leads[r];
    }
    for (int round = 0; round < kRounds; ++round) {
      const SweepColumns columns = columns_now();
      if (columns.tick.empty()) return;
      const auto azimuth = azimuths();
      std::vector<std::vector<double>> turns(rows);
      std::vector<std::vector<double>> inverses(rows);
      for (std::size_t i = 0; i < polar_.size(); ++i) {
        if (row_of_point_[i] < 0 || columns.column_of_point[i] < 0) continue;
        const double tick = columns.tick[static_cast<std::size_t>(columns.column_of_point[i])];
        const auto r = static_cast<std::size_t>(row_of_point_[i]);
        turns[r].push_back(
            std::remainder(static_cast<double>(azimuth[i]) - tick / columns.ticks_per_turn * kTurn, kTurn));
        inverses[r].push_back(1 / static_cast<double>(polar_.rho_m[i]));
      }
      for (std::size_t r = 0; r < rows; ++r) {
        if (turns[r].size() < 20) continue;
        // A line over 1 / rho, points far from it left out.
        double alpha = 0;
        double side = 0;
        double limit = 0.01;
        for (int pass = 0; pass < 4; ++pass) {
          double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, misfit = 0;
          for (std::size_t k = 0; k < turns[r].size(); ++k) {
            const double away = turns[r][k] - alpha - side * inverses[r][k];
            if (std::fabs(away) > limit) continue;
            const double weight = 1 / std::max(inverses[r][k] * inverses[r][k], 1.0 / 900);
            n += weight;
            misfit += weight * std::fabs(away);
            sx += weight * inverses[r][k];
            sxx += weight * inverses[r][k] * inverses[r][k];
            sy += weight * turns[r][k];
            sxy += weight * inverses[r][k] * turns[r][k];
          }
          if (!(n > 0)) break;
          const double spread = sxx - sx * sx / n;
          if (spread > 0.01 * sxx) side = std::clamp((sxy - sx * sy / n) / spread, -kMostSideM, kMostSideM);
          alpha = (sy - side * sx) / n;
          limit = std::max(4 * misfit / n, 1e-4);
        }
        model_.rows[r].azimuth_rad += alpha;
        model_.rows[r].side_offset_m =
            std::clamp(model_.rows[r].side_offset_m + side, -kMostSideM, kMostSideM);
      }
    }
  }

  SweepColumns columns_now() const {
    constexpr double kFineM = 0.002;
    GridOptions options;
    options.max_error_m = kFineM;
    const auto azimuth = azimuths();
    if (const auto firing = find_firing_order(azimuth, row_of_point_))
      return find_columns(model_, polar_, row_of_point_, firing->azimuth_rad, true, options);
    return find_columns(model_, polar_, row_of_point_, azimuth, false, options);
  }

  void centre_azimuths() {
    std::vector<double> all;
    for (RowModel& row : model_.rows) {
      row.azimuth_rad = std::remainder(row.azimuth_rad, kTurn);
      all.push_back(row.azimuth_rad);
    }
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
    double middle = all[all.size() / 2];
    if (model_.ticks_per_turn > 0)
      middle = std::nearbyint(middle / kTurn * model_.ticks_per_turn) * kTurn / model_.ticks_per_turn;
    for (RowModel& row : model_.rows) row.azimuth_rad -= middle;
  }

  void find_row_sequence(bool in_firing_order) {
    if (in_firing_order) {
      SweepColumns columns = columns_now();
      if (const auto firing = find_firing_order(azimuths(), row_of_point_); firing && firing->descending) {
        const auto last = static_cast<std::int32_t>(columns.tick.size()) - 1;
        for (std::int32_t& column : columns.column_of_point) column = column < 0 ? -1 : last - column;
      }
      auto sequence = find_firing_sequence(row_of_point_, columns.column_of_point, model_.rows.size());
      model_.row_sequence = std::move(sequence.rows);
      model_.row_delay = std::move(sequence.delay);
      return;
    }
    // By where the middle of each row stands in the cloud.
    model_.row_sequence.resize(model_.rows.size());
    std::iota(model_.row_sequence.begin(), model_.row_sequence.end(), std::uint16_t{0});
    std::stable_sort(model_.row_sequence.begin(), model_.row_sequence.end(),
                     [&](std::uint16_t a, std::uint16_t b) {
                       return points_[a][points_[a].size() / 2] < points_[b][points_[b].size() / 2];
                     });
  }

  const PolarPoints& polar_;
  int threads_;
  SensorModel model_;
  RowPoints points_;  // per row of the model
  std::vector<std::int16_t> row_of_point_;
};

bool is_usable(const SensorModel& model, const GriddedSweep& sweep) {
  const SensorDiagnosis diagnosis = diagnose(model, std::span(&sweep, 1));
  const auto of = [&](StrayReason reason) {
    return diagnosis.points_by_reason[static_cast<std::size_t>(reason)];
  };
  const std::size_t placed = of(StrayReason::none);
  const std::size_t strays =
      of(StrayReason::off_row) + of(StrayReason::off_column) + of(StrayReason::collision);
  return placed > 0 && static_cast<double>(strays) <= kMostStrays * static_cast<double>(placed + strays) &&
         diagnosis.occupancy >= kLeastOccupancy;
}

}  // namespace

bool SensorEstimator::accept(SensorModel model, const PointCloud& cloud) {
  if (model.rows.empty()) return false;
  const GriddedSweep sweep = project(model, cloud, options_);
  if (!is_usable(model, sweep)) return false;
  refinement_.emplace(std::move(model));
  take_in(cloud, sweep, {});
  return true;
}

void SensorEstimator::take_in(const PointCloud& cloud, const GriddedSweep& sweep, const RowsInTurn& turn) {
  const RowSamples samples = take_row_samples(refinement_->base(), cloud, sweep, turn);
  refinement_->add(samples);
  lattice_.add(samples);
  model_ = refined_ > 0 ? refinement_->refined() : refinement_->base();
  lattice_.write_to(*model_, refinement_->base());
}

void SensorEstimator::refine(const PointCloud& cloud, const GriddedSweep& sweep) {
  if (is_settled()) return;
  const RowsInTurn turn = {refined_ % turns_, turns_};
  ++refined_;
  take_in(cloud, sweep, turn);
}

void SensorEstimator::add(const PointCloud& cloud) {
  if (model_) {
    if (!is_settled()) refine(cloud, project(*model_, cloud, options_));
    return;
  }
  const PolarPoints polar = polar_points(cloud, {}, options_.threads);
  for (const EvidenceKind kind : {EvidenceKind::ring, EvidenceKind::runs, EvidenceKind::elevations}) {
    const RowEvidence evidence = find_row_evidence(kind, cloud, polar);
    if (evidence.points.empty()) continue;
    SensorModel model = ModelFit(polar, evidence, options_.threads).fit();
    if (model.ticks_per_turn == 0) {
      const auto blind = find_twist_blind(cloud, evidence.points);
      if (blind && blind->scatter_m < kCompensatedScatterM) {
        SensorModel compensated =
            ModelFit(polar_points(cloud, blind->twist, options_.threads), evidence, options_.threads).fit();
        compensated.motion_compensated = true;
        if (compensated.ticks_per_turn > 0 && accept(std::move(compensated), cloud)) return;
      }
    }
    if (accept(std::move(model), cloud)) return;
  }
}

}  // namespace pointreel
