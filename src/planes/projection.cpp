#include "planes/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/parallel.h"

namespace pointreel {
namespace {

// Plain numbers in a fixed order of operations: Eigen may order sums differently from one processor to the
// next, and decoded points must not depend on that.
struct RigidMotion {
  explicit RigidMotion(const Pose& pose) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rotation[i][j] = pose.linear()(i, j);
      translation[i] = pose.translation()(i);
    }
  }
  std::array<double, 3> apply(double x, double y, double z) const {
    std::array<double, 3> moved{};
    for (int i = 0; i < 3; ++i) {
      moved[i] = rotation[i][0] * x + rotation[i][1] * y + rotation[i][2] * z + translation[i];
    }
    return moved;
  }
  std::array<double, 3> apply_inverse(double x, double y, double z) const {
    const double dx = x - translation[0], dy = y - translation[1], dz = z - translation[2];
    std::array<double, 3> moved{};
    for (int i = 0; i < 3; ++i) moved[i] = rotation[0][i] * dx + rotation[1][i] * dy + rotation[2][i] * dz;
    return moved;
  }

  double rotation[3][3] = {};
  double translation[3] = {};
};

}  // namespace

std::vector<ProjectedPoint> project_points(const AngularGrid& grid, const PointCloud& cloud,
                                           const Pose& T_key_sensor, int threads) {
  const RigidMotion motion(T_key_sensor);
  std::vector<ProjectedPoint> projected(cloud.size());
  const auto project = [&](std::size_t begin, std::size_t end) {
    // Blocks that stay in the cache between the passes; each pass is one SIMD loop.
    constexpr std::size_t kBlock = 512;
    float x[kBlock], y[kBlock], z[kBlock];
    for (; begin < end; begin += kBlock) {
      const std::size_t size = std::min(kBlock, end - begin);
      const Point3f* points = &cloud.positions[begin];
      ProjectedPoint* results = &projected[begin];
      for (std::size_t i = 0; i < size; ++i) {
        const Point3f p = points[i];
        const auto [mx, my, mz] = motion.apply(p.x, p.y, p.z);
        const double range_m = std::sqrt(mx * mx + my * my + mz * mz);
        const bool usable = range_m > 0 && range_m <= kFarthestPoint_m;  // false for NaN and infinity, too
        results[i].range_m = usable ? static_cast<float>(range_m) : 0.0f;
        x[i] = usable ? static_cast<float>(mx) : 1.0f;
        y[i] = usable ? static_cast<float>(my) : 0.0f;
        z[i] = usable ? static_cast<float>(mz) : 0.0f;
      }
      for (std::size_t i = 0; i < size; ++i) results[i].cell = grid.cell_of(x[i], y[i], z[i]);
    }
  };
  constexpr std::size_t kPointsPerTask = 1 << 14;
  parallel_for((cloud.size() + kPointsPerTask - 1) / kPointsPerTask, threads, [&](std::size_t task) {
    project(task * kPointsPerTask, std::min((task + 1) * kPointsPerTask, cloud.size()));
  });
  return projected;
}

Result<RangeImage> range_image_of(const AngularGrid& grid, const std::vector<ProjectedPoint>& points,
                                  int tile_size) {
  RangeImage image;
  image.columns = grid.columns();
  int first = grid.rows(), last = -1;
  for (const ProjectedPoint& point : points) {
    if (!(point.range_m > 0)) continue;
    first = std::min(first, point.cell.row);
    last = std::max(last, point.cell.row);
  }
  if (last < 0) return image;
  image.first_row = first / tile_size * tile_size;
  image.rows = (last / tile_size + 1) * tile_size - image.first_row;
  const std::size_t cells = image.index(image.rows, 0);
  if (cells > kMaxImageCells) {
    return Error{ErrorCode::resource_limit, "the sweep's range image has " + std::to_string(cells) +
                                                " cells, more than " + std::to_string(kMaxImageCells) +
                                                ": choose a coarser --azimuth-step or --elevation-step"};
  }
  image.range_m.assign(cells, 0.0f);
  for (const ProjectedPoint& point : points) {
    if (!(point.range_m > 0)) continue;
    float& range_m = image.at(point.cell.row - image.first_row, point.cell.column);
    if (range_m == 0 || point.range_m < range_m) range_m = point.range_m;
  }
  return image;
}

PointCloud cloud_of(const AngularGrid& grid, const RangeImage& image, const Pose& T_key_sensor) {
  const RigidMotion motion(T_key_sensor);
  PointCloud cloud;
  if (image.rows == 0) return cloud;
  cloud.positions.resize(image.range_m.size());
  std::size_t count = 0;
  // Row by row: the occupied cells are picked out first, so that the arithmetic is one SIMD loop.
  std::vector<float> range_m(static_cast<std::size_t>(image.columns));
  std::vector<int> column_of(range_m.size());
  for (int row = 0; row < image.rows; ++row) {
    const float* ranges = &image.range_m[image.index(row, 0)];
    std::size_t occupied = 0;
    for (int column = 0; column < image.columns; ++column) {
      range_m[occupied] = ranges[column];
      column_of[occupied] = column;
      occupied += ranges[column] > 0 ? 1 : 0;
    }
    const double cos_e = grid.cos_elevation(image.first_row + row);
    const double sin_e = grid.sin_elevation(image.first_row + row);
    Point3f* points = &cloud.positions[count];
    for (std::size_t i = 0; i < occupied; ++i) {
      const double across_m = range_m[i] * cos_e;
      const auto [x, y, z] =
          motion.apply_inverse(across_m * grid.cos_azimuth(column_of[i]),
                               across_m * grid.sin_azimuth(column_of[i]), range_m[i] * sin_e);
      points[i] = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
    count += occupied;
  }
  cloud.positions.resize(count);
  return cloud;
}

}  // namespace pointreel
