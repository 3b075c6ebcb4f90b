#include "sensor/burst_sort.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "sensor/point_order.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"
#include "support/clouds.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

// Bursts of about `mean` points.
std::vector<std::uint32_t> random_bursts(std::size_t count, std::uint32_t mean, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> sizes(count);
  for (std::uint32_t& size : sizes) size = 1 + static_cast<std::uint32_t>(random() % (2 * mean));
  return sizes;
}

#ifdef __GLIBCXX__
RC_GTEST_PROP(BurstSort, IsTheSortOfTheGnuLibrary, ()) {
  const auto sizes =
      random_bursts(*rc::gen::inRange<std::size_t>(0, 300), *rc::gen::inRange<std::uint32_t>(1, 400),
                    *rc::gen::arbitrary<std::uint32_t>());
  struct Point {
    double time_s;
    std::uint32_t place;
  };
  std::vector<Point> points;
  for (std::size_t burst = 0; burst < sizes.size(); ++burst) {
    for (std::uint32_t k = 0; k < sizes[burst]; ++k)
      points.push_back({1e9 + static_cast<double>(burst) * 1e-3, static_cast<std::uint32_t>(points.size())});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time_s < b.time_s; });
  const auto places = places_before_sort(sizes);
  RC_ASSERT(places.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) RC_ASSERT(places[i] == points[i].place);
}
#endif

// A sweep in firing order whose columns share a time, six by six, as it comes out of the sort.
struct SortedSweep {
  PointCloud measured, sorted;
  std::vector<std::uint32_t> bursts;
};

SortedSweep sorted_sweep(bool with_rings) {
  const PointCloud plain = simulated_drive(1, SensorKind::hdl_64e)[0].cloud;
  SensorEstimator estimator;
  estimator.add(plain);
  const GriddedSweep grid = project(*estimator.model(), plain);
  const std::size_t columns = grid.grid.column_count();
  std::vector<std::size_t> points(plain.size());
  std::iota(points.begin(), points.end(), std::size_t{0});
  const auto column_of = [&](std::size_t i) {
    return static_cast<std::size_t>(std::max(grid.cell_of_point[i], 0)) % columns;
  };
  std::stable_sort(points.begin(), points.end(),
                   [&](std::size_t a, std::size_t b) { return column_of(a) < column_of(b); });
  SortedSweep sweep;
  std::vector<double> times_s;
  std::vector<std::uint16_t> rings;
  for (const std::size_t i : points) {
    sweep.measured.positions.push_back(plain.positions[i]);
    const std::size_t burst = column_of(i) / 6;
    rings.push_back(
        static_cast<std::uint16_t>(static_cast<std::size_t>(std::max(grid.cell_of_point[i], 0)) / columns));
    if (times_s.empty() || times_s.back() != static_cast<double>(burst)) sweep.bursts.push_back(0);
    ++sweep.bursts.back();
    times_s.push_back(static_cast<double>(burst));
  }
  if (with_rings) sweep.measured.fields.push_back({"ring", std::move(rings)});
  sweep.measured.fields.push_back({"timestamp", std::move(times_s)});
  sweep.sorted = sweep.measured;
  redo_sort(sweep.bursts, sweep.sorted);
  return sweep;
}

TEST(BurstSort, IsSeenAndUndone) {
  for (const bool with_rings : {false, true}) {
    const SortedSweep sweep = sorted_sweep(with_rings);
    PointCloud cloud = sweep.sorted;
    EXPECT_NE(cloud.positions, sweep.measured.positions);
    EXPECT_EQ(undo_sort(cloud), sweep.bursts);
    EXPECT_EQ(cloud.positions, sweep.measured.positions);
    EXPECT_EQ(cloud.fields, sweep.measured.fields);
  }
}

TEST(BurstSort, IsNotSeenWhereThereWasNone) {
  PointCloud measured = sorted_sweep(true).measured;
  EXPECT_TRUE(undo_sort(measured).empty());
  PointCloud rows = simulated_drive(1)[0].cloud;
  EXPECT_TRUE(undo_sort(rows).empty());
  for (const NamedCloud& named : awkward_clouds()) {
    SCOPED_TRACE(named.name);
    PointCloud cloud = named.cloud;
    std::vector<float> times_s(cloud.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) times_s[i] = static_cast<float>(i / 50);
    cloud.fields.push_back({"time", std::move(times_s)});
    const PointCloud before = cloud;
    if (undo_sort(cloud).empty()) {
      EXPECT_EQ(cloud.fields, before.fields);
    }
  }
}

TEST(BurstSort, SizesCostLittleWhereColumnsTellThem) {
  const SortedSweep sweep = sorted_sweep(true);
  SensorEstimator estimator;
  estimator.add(sweep.measured);
  ASSERT_TRUE(estimator.model());
  const GriddedSweep grid = project(*estimator.model(), sweep.measured);
  ASSERT_EQ(grid.grid.order.kind, OrderKind::column_major);
  const auto of_cells = firing_places_of(*estimator.model(), grid.grid, cells_of_points(grid));
  FiringPlaces places{{}, static_cast<std::int32_t>(estimator.model()->row_count())};
  std::size_t next = 0;
  for (const std::int32_t cell : grid.cell_of_point)
    places.of_point.push_back(cell < 0 ? -1 : of_cells[next++]);
  const auto bytes = encode_bursts(sweep.bursts, places);
  EXPECT_LT(bytes.size(), sweep.bursts.size() / 4);
  const auto decoded = decode_bursts(places, bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, sweep.bursts);
}

RC_GTEST_PROP(BurstSort, SizesComeBackWhateverThePlaces, ()) {
  const auto sizes =
      random_bursts(*rc::gen::inRange<std::size_t>(0, 100), 30, *rc::gen::arbitrary<std::uint32_t>());
  FiringPlaces places{{}, *rc::gen::inRange(1, 80)};
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  for (std::uint32_t i = 0; i < std::accumulate(sizes.begin(), sizes.end(), 0u); ++i)
    places.of_point.push_back(static_cast<std::int32_t>(random() % 3000) - 1);
  const auto decoded = decode_bursts(places, encode_bursts(sizes, places));
  RC_ASSERT(static_cast<bool>(decoded));
  RC_ASSERT(*decoded == sizes);
}

RC_GTEST_PROP(BurstSort, AnyBytesAreAnErrorOrBurstsOfAllPoints, (std::vector<std::uint8_t> bytes)) {
  FiringPlaces places{std::vector<std::int32_t>(1000), 16};
  std::iota(places.of_point.begin(), places.of_point.end(), 0);
  const auto sizes = decode_bursts(places, bytes);
  if (!sizes) return;
  RC_ASSERT(std::accumulate(sizes->begin(), sizes->end(), 0u) == 1000u);
}

}  // namespace
}  // namespace pointreel
