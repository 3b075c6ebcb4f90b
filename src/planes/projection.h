// Points to range image and back (paper, section III-B).
#pragma once

#include <cstdint>
#include <vector>

#include "planes/angular_grid.h"
#include "planes/range_image.h"
#include "pointreel/motion.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

// Points farther than this, and points at the sensor's origin, have no place in a range image; they are
// counted as lost with the collided ones.
inline constexpr double kFarthestPoint_m = 100'000;
// Cells of a range image at most: bounds the memory that any input, or any bytes, can ask for.
inline constexpr std::size_t kMaxImageCells = std::size_t{1} << 24;

// Where each point of a cloud falls: its range after moving it by T_key_sensor, and its cell; range 0 =
// nowhere.
struct ProjectedPoint {
  GridCell cell;
  float range_m = 0;
};
std::vector<ProjectedPoint> project_points(const AngularGrid& grid, const PointCloud& cloud,
                                           const Pose& T_key_sensor, int threads = 1);

// Nearest point of each cell. Error resource_limit when the used band of rows has more than kMaxImageCells
// cells.
Result<RangeImage> range_image_of(const AngularGrid& grid, const std::vector<ProjectedPoint>& points,
                                  int tile_size);

// One point per occupied cell in raster order, moved back by the inverse of T_key_sensor.
PointCloud cloud_of(const AngularGrid& grid, const RangeImage& image, const Pose& T_key_sensor);

}  // namespace pointreel
