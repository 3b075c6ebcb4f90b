// Range images of made-up scenes for the tests of src/planes.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/trigonometry.h"
#include "planes/plane_run.h"

namespace pointreel {

inline AngularGrid grid_of_degrees(double azimuth_step_deg, double elevation_step_deg) {
  auto grid =
      AngularGrid::create(degrees_to_radians(azimuth_step_deg), degrees_to_radians(elevation_step_deg));
  return *std::move(grid);
}

struct Ray {
  double x, y, z;
};

inline Ray centre_ray(const AngularGrid& grid, int grid_row, int column) {
  const double cos_e = grid.cos_elevation(grid_row);
  return {cos_e * grid.cos_azimuth(column), cos_e * grid.sin_azimuth(column), grid.sin_elevation(grid_row)};
}

inline RangeImage empty_image(const AngularGrid& grid, int first_row, int rows) {
  RangeImage image;
  image.first_row = first_row;
  image.rows = rows;
  image.columns = grid.columns();
  image.range_m.assign(image.index(rows, 0), 0.0f);
  return image;
}

// What a sensor at the origin sees of planes n.p = 1: the nearest in front of each ray within 120 m.
inline RangeImage image_of_planes(const AngularGrid& grid, int first_row, int rows,
                                  const std::vector<Plane>& planes) {
  RangeImage image = empty_image(grid, first_row, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const Ray ray = centre_ray(grid, first_row + row, column);
      double nearest_m = 120;
      for (const Plane& plane : planes) {
        const double range_m = 1 / (plane.x * ray.x + plane.y * ray.y + plane.z * ray.z);
        if (range_m > 0) nearest_m = std::min(nearest_m, range_m);
      }
      if (nearest_m < 120) image.at(row, column) = static_cast<float>(nearest_m);
    }
  }
  return image;
}

// Flat ground 1.73 m below the sensor between walls 10 m ahead, 18 m behind, 6 m left and 8 m right.
inline std::vector<Plane> street_canyon() {
  return {{0, 0, -1 / 1.73}, {1 / 10.0, 0, 0}, {-1 / 18.0, 0, 0}, {0, 1 / 6.0, 0}, {0, -1 / 8.0, 0}};
}

inline void add_noise(RangeImage& image, float deviation_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise_m(0, deviation_m);
  for (float& range_m : image.range_m) {
    if (range_m > 0) range_m = std::max(0.01f, range_m + noise_m(random));
  }
}

inline std::size_t count_occupied(const RangeImage& image) {
  return static_cast<std::size_t>(
      std::count_if(image.range_m.begin(), image.range_m.end(), [](float range_m) { return range_m > 0; }));
}

}  // namespace pointreel
