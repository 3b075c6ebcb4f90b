#include "pointreel/point_cloud.h"

#include <algorithm>
#include <cmath>

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
  return static_cast<std::size_t>(
      std::count_if(positions.begin(), positions.end(), [](const Point3f& p) { return !is_finite(p); }));
}

}  // namespace pointreel
