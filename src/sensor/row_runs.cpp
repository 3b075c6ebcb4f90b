#include "sensor/row_runs.h"

#include <numbers>

namespace pointreel {

RowRuns split_into_runs(const PolarPoints& polar) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const auto turned = [&](std::size_t i) {
    const float a = polar.azimuth_rad[i];
    return a < 0 ? a + kTurn : a;
  };
  // Which way the sensor turns: the sign of most small steps.
  std::size_t up = 0;
  std::size_t down = 0;
  float before = 0;
  bool any = false;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const float a = turned(i);
    if (any && a > before && a - before < 0.1F) ++up;
    if (any && a < before && before - a < 0.1F) ++down;
    before = a;
    any = true;
  }
  RowRuns runs;
  runs.descending = down > up;
  any = false;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (!polar.has_ray(i)) continue;
    const float a = turned(i);
    const float back = runs.descending ? a - before : before - a;
    if (!any) {
      runs.first.push_back(0);
    } else if (back > 1) {
      runs.first.push_back(i);
    }
    before = a;
    any = true;
  }
  return runs;
}

}  // namespace pointreel
