#include "common/field_quality.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <variant>

namespace pointreel {
namespace {

// Of two values that are not the same to the bit.
template <class T>
double difference(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    const double difference = std::fabs(static_cast<double>(a) - static_cast<double>(b));
    if (std::isnan(a) && std::isnan(b)) return 0;
    return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
  } else {
    // Unsigned, so that no 64-bit difference overflows or is rounded away.
    const auto low = static_cast<std::uint64_t>(std::min(a, b)),
               high = static_cast<std::uint64_t>(std::max(a, b));
    return static_cast<double>(high - low);
  }
}

template <class T>
void compare(const std::vector<T>& original, const std::vector<T>& decoded,
             const std::vector<std::int64_t>& pairs, FieldDifference& worst) {
  for (std::size_t i = 0; i < original.size(); ++i) {
    if (pairs[i] < 0) continue;
    const T& a = original[i];
    const T& b = decoded[static_cast<std::size_t>(pairs[i])];
    if (std::memcmp(&a, &b, sizeof(T)) == 0) continue;
    worst.exact = false;
    worst.max = std::max(worst.max, difference(a, b));
  }
}

}  // namespace

Result<void> compare_fields(const PointCloud& original, const DecodedSweep& decoded,
                            const std::vector<std::int64_t>& pairs, FieldDifferences& differences) {
  for (const Field& field : decoded.cloud.fields) {
    const Field* before = original.find_field(field.name);
    if (before == nullptr || before->values.index() != field.values.index()) {
      return Error{ErrorCode::invalid_argument,
                   "the original has no field " + field.name + " of that type: not the same sweep"};
    }
    FieldDifference& worst = differences[field.name];
    std::visit(
        [&](const auto& values) {
          compare(values, std::get<std::remove_cvref_t<decltype(values)>>(field.values), pairs, worst);
        },
        before->values);
  }
  return {};
}

}  // namespace pointreel
