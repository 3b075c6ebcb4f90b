// Clouds for tests: awkward ones, and sweeps of a small simulated drive.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/simulator.h"

namespace pointreel {

inline PointCloud cloud_of_points(std::vector<Point3f> positions) {
  return {std::move(positions), {}};
}

// Points all around, at `range_m` give or take a fifth.
inline PointCloud random_sphere(std::size_t count, float range_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  std::uniform_real_distribution<float> scale(0.8f * range_m, 1.2f * range_m);
  PointCloud cloud;
  while (cloud.size() < count) {
    const Point3f p{normal(random), normal(random), normal(random)};
    const float length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    if (length < 1e-3f) continue;
    const float k = scale(random) / length;
    cloud.positions.push_back({k * p.x, k * p.y, k * p.z});
  }
  return cloud;
}

// Of a car that has pulled away and does 15 m/s.
inline Simulator simulator_at_speed(SensorKind sensor) {
  constexpr int kPullingAway = 60;
  SimulatorOptions options;
  options.sensor = sensor;
  options.cruise_speed_mps = 15;
  Simulator simulator(options);
  for (int i = 0; i < kPullingAway; ++i) static_cast<void>(simulator.next_sweep());
  return simulator;
}

struct NamedCloud {
  std::string name;
  PointCloud cloud;
};

// Every kind of cloud that a sensor, a driver or a careless exporter may hand over.
inline std::vector<NamedCloud> awkward_clouds() {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  std::vector<NamedCloud> clouds = {
      {"empty", {}},
      {"one point", cloud_of_points({{3, 4, -1}})},
      {"all equal", cloud_of_points(std::vector<Point3f>(500, {3, 4, -1}))},
      {"all at the origin", cloud_of_points(std::vector<Point3f>(100))},
      {"nothing finite", cloud_of_points({{nan, 0, 0}, {0, infinity, 1}, {1, 2, -infinity}})},
      {"straight up and down", cloud_of_points({{0, 0, 5}, {0, 0, -5}, {1e-20f, 0, 5}, {-0.0f, -0.0f, -6}})},
      {"smaller than a hair", random_sphere(300, 1e-4f, 1)},
      {"inside the housing", random_sphere(3000, 0.05f, 2)},
      {"10 km away", random_sphere(3000, 1e4f, 3)},
      {"beyond all bounds", cloud_of_points({{1e6f, 0, 0}, {3e38f, 3e38f, 3e38f}, {1e-40f, 0, 0}})},
  };
  PointCloud mixed = random_sphere(2000, 12, 4);
  for (std::size_t i = 0; i < mixed.size(); i += 7) mixed.positions[i].y = i % 2 ? nan : infinity;
  for (std::size_t i = 3; i < mixed.size(); i += 11) mixed.positions[i] = {};
  for (std::size_t i = 5; i < mixed.size(); i += 13) mixed.positions[i] = mixed.positions[i - 1];
  clouds.push_back({"unordered with duplicates, NaN and zeros", std::move(mixed)});
  return clouds;
}

inline std::vector<SimulatedSweep> simulated_drive(int frames, SensorKind sensor = SensorKind::vlp_16) {
  SimulatorOptions options;
  options.sensor = sensor;
  Simulator simulator(options);
  std::vector<SimulatedSweep> sweeps;
  sweeps.reserve(static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i) sweeps.push_back(simulator.next_sweep());
  return sweeps;
}

// Folder of real sweeps, not part of the repository; none when $POINTREEL_DATA is not set.
inline std::optional<std::filesystem::path> real_data_folder() {
  const char* folder = std::getenv("POINTREEL_DATA");
  if (folder == nullptr) return {};
  return folder;
}

}  // namespace pointreel
