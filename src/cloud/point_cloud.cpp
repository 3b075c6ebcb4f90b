#include "pointreel/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd_loops.h"

namespace pointreel {
namespace {

POINTREEL_SIMD_LOOPS bool all_finite(const float* values, std::size_t count) {
  int any = 0;
  for (std::size_t k = 0; k < count; ++k)
    any |= std::fabs(values[k]) <= std::numeric_limits<float>::max() ? 0 : 1;
  return any == 0;
}

}  // namespace

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
  // Hardly a cloud has any.
  static_assert(sizeof(Point3f) == 3 * sizeof(float));
  if (all_finite(&positions[0].x, 3 * positions.size())) return 0;
  return static_cast<std::size_t>(
      std::count_if(positions.begin(), positions.end(), [](const Point3f& p) { return !is_finite(p); }));
}

}  // namespace pointreel
