#include "study_series.h"

#include <numbers>

#include "base/parallel.h"

namespace pointreel {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr int kSingleFrame = 1;
constexpr int kStreaming = 5;  // the paper's group
constexpr int kLongGroup = 15;
constexpr double kAccurate_m = 0.1, kCoarse_m = 0.5;  // thresholds of series that vary something else

Setting setting_of(const SweepSet& set, int threads, double threshold_m, int group) {
  Setting setting;
  setting.planes.threshold_m = threshold_m;
  setting.planes.group = group;
  setting.motion = set.best_motion();
  setting.threads = threads;
  return setting;
}

bool fits(const SweepSet& set, int group) {
  return static_cast<std::size_t>(group) <= set.sweeps.size();
}

std::vector<int> group_sizes(const SweepSet& set) {
  std::vector<int> sizes;
  for (const int group : {1, 3, 5, 7, 9, 11, 13, 15, 17, 19}) {
    if (fits(set, group)) sizes.push_back(group);
  }
  return sizes;
}

Series threshold_series(const SweepSet& set, int threads) {
  Series series{"threshold", {}};
  for (const int group : {kSingleFrame, kStreaming}) {
    for (const double threshold_m : {0.02, 0.05, 0.1, 0.2, 0.5})
      series.settings.push_back(setting_of(set, threads, threshold_m, group));
  }
  return series;
}

Series resolution_series(const SweepSet& set, int threads) {
  struct CellSize {
    double azimuth_deg, elevation_deg;
  };
  constexpr CellSize kCellSizes[] = {{0.09, 0.2}, {0.12, 0.3}, {0.18, 0.45}, {0.25, 0.6}, {0.36, 0.9}};
  Series series{"resolution", {}};
  for (const int group : {kSingleFrame, kStreaming}) {
    for (const double threshold_m : {kAccurate_m, kCoarse_m}) {
      for (const CellSize& cell : kCellSizes) {
        Setting setting = setting_of(set, threads, threshold_m, group);
        setting.planes.azimuth_step_rad = cell.azimuth_deg * kRadPerDeg;
        setting.planes.elevation_step_rad = cell.elevation_deg * kRadPerDeg;
        series.settings.push_back(setting);
      }
    }
  }
  return series;
}

Series group_series(const SweepSet& set, int threads) {
  Series series{"group", {}, true};
  for (const double threshold_m : {kAccurate_m, kCoarse_m}) {
    for (const int group : group_sizes(set))
      series.settings.push_back(setting_of(set, threads, threshold_m, group));
  }
  return series;
}

Series tile_series(const SweepSet& set, int threads) {
  Series series{"tile", {}};
  for (const int group : {kSingleFrame, kStreaming}) {
    for (const ResidualMode residual : {ResidualMode::stepped, ResidualMode::raw_float}) {
      for (const int tile_size : {2, 4, 8, 16}) {
        Setting setting = setting_of(set, threads, kAccurate_m, group);
        setting.planes.residual_mode = residual;
        setting.planes.tile_size = tile_size;
        series.settings.push_back(setting);
      }
    }
  }
  return series;
}

Series motion_series(const SweepSet& set, int threads) {
  std::vector<int> groups = {kStreaming};
  if (fits(set, kLongGroup)) groups.push_back(kLongGroup);
  Series series{"motion", {}};
  for (const double threshold_m : {kAccurate_m, kCoarse_m}) {
    for (const int group : groups) {
      for (const MotionSource motion : set.motion_sources()) {
        Setting setting = setting_of(set, threads, threshold_m, group);
        setting.motion = motion;
        series.settings.push_back(setting);
      }
    }
  }
  return series;
}

}  // namespace

std::vector<Series> study_series(const SweepSet& set, int threads) {
  return {threshold_series(set, threads), resolution_series(set, threads), group_series(set, threads),
          tile_series(set, threads), motion_series(set, threads)};
}

std::vector<Setting> speedup_settings(const SweepSet& set, int threads) {
  const int most = resolve_threads(threads);
  std::vector<Setting> settings;
  for (int count = 2; count < most; ++count)
    settings.push_back(setting_of(set, count, kAccurate_m, kStreaming));
  for (const int group : {1, 3, 5, 9, 13, 19}) {
    if (fits(set, group)) settings.push_back(setting_of(set, most, kAccurate_m, group));
  }
  return settings;
}

}  // namespace pointreel
