// One-to-one matching of two point sets within a distance, for clouds whose order was not kept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"

namespace pointreel {

// For each original point the index of its decoded point, no farther than max_error_m, no index twice; -1 for
// those left over and for points that are not finite. As many pairs as there can be, so that none is missing
// when every point kept the bound.
std::vector<std::int64_t> match_points(std::span<const Point3f> originals, std::span<const Point3f> decoded,
                                       double max_error_m);

}  // namespace pointreel
