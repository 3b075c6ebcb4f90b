// Clouds of every kind: a model or none, and a grid that keeps its promises.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "grid_checks.h"
#include "sensor/sensor_estimator.h"
#include "support/clouds.h"

namespace pointreel {
namespace {

const SensorModel& simulated_model() {
  static const SensorModel model = [] {
    SensorEstimator estimator;
    estimator.add(simulated_drive(1)[0].cloud);
    return *estimator.model();
  }();
  return model;
}

TEST(AnyCloud, FitsTheModelOfAnotherSensorOrBecomesStrays) {
  SensorModel compensated = simulated_model();
  compensated.motion_compensated = true;
  SensorModel free = simulated_model();
  free.ticks_per_turn = 0;
  for (const NamedCloud& named : awkward_clouds()) {
    SCOPED_TRACE(named.name);
    for (const SensorModel* model : {&simulated_model(), static_cast<const SensorModel*>(&compensated),
                                     static_cast<const SensorModel*>(&free)})
      check_grid(*model, named.cloud, project(*model, named.cloud));
  }
}

TEST(AnyCloud, IsEstimatedOrRefused) {
  auto clouds = awkward_clouds();
  clouds.push_back({"ball", random_sphere(30000, 20, 7)});
  for (const NamedCloud& named : clouds) {
    SCOPED_TRACE(named.name);
    SensorEstimator estimator;
    estimator.add(named.cloud);
    if (estimator.model())
      check_grid(*estimator.model(), named.cloud, project(*estimator.model(), named.cloud));
  }
}

TEST(AnyCloud, ModelWithoutRowsMakesStrays) {
  const PointCloud cloud = random_sphere(100, 5, 1);
  SensorModel model;
  model.ticks_per_turn = 100;
  const GriddedSweep sweep = project(model, cloud);
  EXPECT_EQ(std::count(sweep.cell_of_point.begin(), sweep.cell_of_point.end(), -1), 100);
}

TEST(AnyCloud, RingsThatContradictTheHeightsAreNotBelieved) {
  PointCloud cloud = simulated_drive(1)[0].cloud;
  std::vector<std::uint8_t> rings(cloud.size());
  for (std::size_t i = 0; i < rings.size(); ++i)
    rings[i] = static_cast<std::uint8_t>(i * 2654435761u >> 13) % 16;
  cloud.fields.push_back({"ring", std::move(rings)});
  SensorEstimator estimator;
  estimator.add(cloud);
  ASSERT_TRUE(estimator.model());
  EXPECT_TRUE(estimator.model()->ring_of_row.empty());
  EXPECT_EQ(estimator.model()->rows.size(), 16u);
}

RC_GTEST_PROP(AnyCloud, KeepsThePromisesOfTheGrid, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  const auto count = *rc::gen::inRange<std::size_t>(0, 400);
  const auto range_m = static_cast<float>(*rc::gen::element(0.01, 1.0, 30.0, 5000.0));
  PointCloud cloud = random_sphere(count, range_m, seed);
  GridOptions options;
  options.max_deviation_m = *rc::gen::element(0.01, 1.0, 1000.0);
  check_grid(simulated_model(), cloud, project(simulated_model(), cloud, options));
}

}  // namespace
}  // namespace pointreel
