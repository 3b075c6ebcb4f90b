// The tests that the search for planes runs on tiles.
#include "planes/tile_samples.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "sensor_scene.h"

namespace pointreel {
namespace {

// Ranges on one plane where rays meet it within 80 m, each off by its tolerance at most; holes.
struct OnOnePlane {
  SensorScene scene{11, 250};
  SensorRays rays = scene.rays();
  Plane plane;
  std::vector<float> range_m, tolerance_m;
  MovedPlanes none;

  explicit OnOnePlane(std::uint32_t seed, float most_tolerance_m) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> share(-1, 1);
    plane = plane_of(share(random), share(random), share(random), 1 + 19 * std::fabs(share(random)));
    for (int row = 0; row < rays.rows(); ++row) {
      std::vector<float> met_m(static_cast<std::size_t>(rays.columns()));
      rays.plane_ranges_m(plane, row, 0, met_m);
      for (const float m : met_m) {
        const bool seen = m > 0.5F && m < 80 && random() % 10 != 0;
        tolerance_m.push_back(most_tolerance_m * std::fabs(share(random)));
        range_m.push_back(seen ? m + 0.999F * tolerance_m.back() * share(random) : 0);
      }
    }
  }
  PlaneTask task() const { return {rays, range_m, tolerance_m, 0.05, none}; }
};

RC_GTEST_PROP(TileSamples, NoTileThatAPlaneHoldsBends, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  const OnOnePlane sweep(seed, *rc::gen::element(0.001F, 0.02F, 0.1F));
  const PlaneTask task = sweep.task();
  const TileSamples samples(task);
  for (int tile_row = 0; tile_row < samples.tiles().down; ++tile_row) {
    const TileSamples::PlaneTest test(samples, sweep.plane, tile_row);
    for (int tile = 0; tile < samples.tiles().across; ++tile) {
      if (!test.holds(tile)) continue;
      RC_ASSERT(!samples.bends(tile_row, tile));
    }
  }
}

TEST(TileSamples, AReturnFarFromItsRowBendsItsTile) {
  constexpr float kToleranceM = 0.01F;
  OnOnePlane sweep(5, kToleranceM);
  sweep.plane = plane_of(1, 0.2, 0.05, 9);
  sweep.tolerance_m.assign(sweep.range_m.size(), kToleranceM);
  const auto columns = static_cast<std::size_t>(sweep.rays.columns());
  for (int row = 0; row < sweep.rays.rows(); ++row)
    sweep.rays.plane_ranges_m(
        sweep.plane, row, 0,
        std::span(sweep.range_m).subspan(static_cast<std::size_t>(row) * columns, columns));
  for (float& range : sweep.range_m) range = range > 1 && range < 20 ? range : 0;
  const auto tests_of = [&](const OnOnePlane& tested, int tile) {
    const PlaneTask task{tested.rays, tested.range_m, tested.tolerance_m, 0.05, tested.none};
    const TileSamples samples(task);
    return std::pair(TileSamples::PlaneTest(samples, sweep.plane, 0).holds(tile), samples.bends(0, tile));
  };
  int broken = 0;
  for (int tile = 0; tile < sweep.rays.columns() / kTileColumns; ++tile) {
    const auto first = static_cast<std::size_t>(tile) * kTileColumns;
    const auto returns = std::span(sweep.range_m).subspan(first, kTileColumns);
    if (std::count(returns.begin(), returns.end(), 0.0F) > 0 || !tests_of(sweep, tile).first) continue;
    EXPECT_FALSE(tests_of(sweep, tile).second) << tile;
    OnOnePlane off = sweep;
    off.range_m[first + 4] += 0.3F;
    EXPECT_FALSE(tests_of(off, tile).first) << tile;
    EXPECT_TRUE(tests_of(off, tile).second) << tile;
    ++broken;
  }
  EXPECT_GT(broken, 5);
}

}  // namespace
}  // namespace pointreel
