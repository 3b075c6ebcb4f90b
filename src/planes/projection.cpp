#include "planes/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

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
    std::array<double, 3> moved;
    for (int i = 0; i < 3; ++i) {
      moved[i] = rotation[i][0] * x + rotation[i][1] * y + rotation[i][2] * z + translation[i];
    }
    return moved;
  }
  std::array<double, 3> apply_inverse(double x, double y, double z) const {
    const double dx = x - translation[0], dy = y - translation[1], dz = z - translation[2];
    std::array<double, 3> moved;
    for (int i = 0; i < 3; ++i) moved[i] = rotation[0][i] * dx + rotation[1][i] * dy + rotation[2][i] * dz;
    return moved;
  }

  double rotation[3][3];
  double translation[3];
};

}  // namespace

std::vector<ProjectedPoint> project_points(const AngularGrid& grid, const PointCloud& cloud,
                                           const Pose& T_key_sensor) {
  const RigidMotion motion(T_key_sensor);
  std::vector<ProjectedPoint> projected(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.positions[i];
    if (!is_finite(p)) continue;
    const auto [x, y, z] = motion.apply(p.x, p.y, p.z);
    const double range_m = std::sqrt(x * x + y * y + z * z);
    if (!(range_m > 0 && range_m <= kFarthestPoint_m)) continue;
    projected[i] = {grid.cell_of(x, y, z), static_cast<float>(range_m)};
  }
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
  if (cells > kMaxCells) {
    return Error{ErrorCode::resource_limit, "the sweep's range image has " + std::to_string(cells) +
                                                " cells, more than " + std::to_string(kMaxCells) +
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
  cloud.positions.reserve(static_cast<std::size_t>(
      std::count_if(image.range_m.begin(), image.range_m.end(), [](float range_m) { return range_m > 0; })));
  for (int row = 0; row < image.rows; ++row) {
    const double cos_e = grid.cos_elevation(image.first_row + row),
                 sin_e = grid.sin_elevation(image.first_row + row);
    for (int column = 0; column < image.columns; ++column) {
      const double range_m = image.at(row, column);
      if (!(range_m > 0)) continue;
      const double across_m = range_m * cos_e;
      const auto [x, y, z] = motion.apply_inverse(across_m * grid.cos_azimuth(column),
                                                  across_m * grid.sin_azimuth(column), range_m * sin_e);
      cloud.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
  }
  return cloud;
}

}  // namespace pointreel
