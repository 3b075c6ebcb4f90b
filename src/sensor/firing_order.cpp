#include "sensor/firing_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/trigonometry.h"

namespace pointreel {
namespace {

constexpr double kSmallStepRad = 0.35;  // rows look up to 20 deg apart
constexpr double kHairRad = 1e-3;

}  // namespace

std::optional<FiringOrder> find_firing_order(std::span<const float> azimuth_rad,
                                             const std::vector<std::int16_t>& rows) {
  // Rows alone tell most clouds that are not.
  std::uint32_t steps = rows.empty() || rows[0] < 0 ? 0 : 1;
  std::uint32_t same_row = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    steps += rows[i] >= 0 ? 1 : 0;
    same_row += (rows[i] >= 0) & (rows[i] == rows[i - 1]) ? 1 : 0;
  }
  if (steps < 32 || same_row * 2 > steps) return {};
  FiringOrder order;
  order.azimuth_rad.assign(azimuth_rad.size(), 0);
  std::size_t small = 0;
  double place = 0;  // follows the rotation, slowly enough not to be led astray by single points
  double lowest = 0;
  double highest = 0;
  double first = 0;
  double last = 0;
  bool any = false;
  for (std::size_t i = 0; i < azimuth_rad.size(); ++i) {
    if (rows[i] < 0) continue;
    const double azimuth = azimuth_rad[i];
    if (!any) place = lowest = highest = first = azimuth;
    const double step = std::remainder(azimuth - place, kTurn);
    order.azimuth_rad[i] = static_cast<float>(place + step);
    any = true;
    if (std::fabs(step) < kSmallStepRad) {
      ++small;
      lowest = std::min(lowest, place + step);
      highest = std::max(highest, place + step);
      last = place + step;
    }
    place += std::clamp(step, -kSmallStepRad, kSmallStepRad) / 4;
  }
  if (small * 20 < steps * 19) return {};
  const double span = highest - lowest;
  // A scan that stays within a part of the turn can be in this order, too, but only if it goes one way.
  if (span >= 1.95 * kTurn || std::fabs(last - first) < 0.8 * span) return {};
  order.descending = last < first;
  // A first point a hair before azimuth 0 stays there.
  const double origin = std::floor((lowest + kHairRad) / kTurn) * kTurn;
  for (std::size_t i = 0; i < azimuth_rad.size(); ++i) {
    if (rows[i] < 0) continue;
    // From the azimuth in [0, 2 pi), whole turns away, so that it is rounded once.
    double azimuth = azimuth_rad[i];
    azimuth += std::nearbyint((order.azimuth_rad[i] - azimuth) / kTurn) * kTurn - origin;
    while (azimuth < -kHairRad) azimuth += kTurn;
    while (azimuth >= 2 * kTurn) azimuth -= kTurn;
    order.azimuth_rad[i] = static_cast<float>(azimuth);
  }
  return order;
}

std::vector<double> row_leads_rad(std::span<const float> azimuth_rad, const std::vector<std::int16_t>& rows,
                                  std::size_t row_count) {
  // Median step to each row from the row most often before it.
  struct Step {
    std::int16_t from;
    double turn;
  };
  std::vector<std::vector<Step>> steps(row_count);
  std::size_t before = rows.size();
  double advance = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    if (before < rows.size()) {
      const double turn = std::remainder(static_cast<double>(azimuth_rad[i] - azimuth_rad[before]), kTurn);
      steps[static_cast<std::size_t>(rows[i])].push_back({rows[before], turn});
      if (std::fabs(turn) < kSmallStepRad) advance += turn;
      ++pairs;
    }
    before = i;
  }
  struct Link {
    std::int16_t from = -1;
    double turn = 0;
  };
  std::vector<Link> links(row_count);
  for (std::size_t r = 0; r < row_count; ++r) {
    std::vector<std::size_t> uses(row_count, 0);
    for (const Step& step : steps[r]) ++uses[static_cast<std::size_t>(step.from)];
    const auto most = std::max_element(uses.begin(), uses.end());
    if (most == uses.end() || *most == 0) continue;
    links[r].from = static_cast<std::int16_t>(most - uses.begin());
    std::vector<double> turns;
    for (const Step& step : steps[r]) {
      if (step.from == links[r].from) turns.push_back(step.turn);
    }
    std::nth_element(turns.begin(), turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2),
                     turns.end());
    links[r].turn = turns[turns.size() / 2];
  }
  // The chain of links is a cycle: it is cut where the azimuth goes ahead most, from one column to the next.
  const double direction = advance < 0 ? -1 : 1;
  std::size_t start = 0;
  for (std::size_t r = 0; r < row_count; ++r) {
    if (links[r].from < 0 || links[r].turn * direction > links[start].turn * direction) start = r;
  }
  std::vector<double> leads(row_count, 0);
  std::vector<std::uint8_t> known(row_count, 0);
  known[start] = 1;
  for (std::size_t round = 0; round < row_count; ++round) {
    bool any = false;
    for (std::size_t r = 0; r < row_count; ++r) {
      if (known[r] != 0 || links[r].from < 0 || known[static_cast<std::size_t>(links[r].from)] == 0) continue;
      leads[r] = leads[static_cast<std::size_t>(links[r].from)] + links[r].turn;
      known[r] = 1;
      any = true;
    }
    if (!any) break;
  }
  const double mean = std::accumulate(leads.begin(), leads.end(), 0.0) / static_cast<double>(row_count);
  for (double& lead : leads) lead -= mean;
  return leads;
}

}  // namespace pointreel
