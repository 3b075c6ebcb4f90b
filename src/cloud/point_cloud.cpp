#include "pointreel/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointreel {

bool is_finite(const Point3f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::size_t Field::size() const {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

const Field* PointCloud::find_field(std::string_view name) const {
  const auto it = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
  return it == fields.end() ? nullptr : &*it;
}

std::size_t PointCloud::count_non_finite() const {
  if (positions.empty()) return 0;
  // Hardly a cloud has any: all coordinates in a row and without branches, as compilers like it.
  static_assert(sizeof(Point3f) == 3 * sizeof(float));
  const float* coordinates = &positions[0].x;
  int any = 0;
  for (std::size_t k = 0; k < 3 * positions.size(); ++k)
    any |= std::fabs(coordinates[k]) <= std::numeric_limits<float>::max() ? 0 : 1;
  if (any == 0) return 0;
  return static_cast<std::size_t>(
      std::count_if(positions.begin(), positions.end(), [](const Point3f& p) { return !is_finite(p); }));
}

}  // namespace pointreel
