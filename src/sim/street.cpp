#include "sim/street.h"

#include <cmath>

namespace pointreel::sim {

void Street::cover(double begin_x_m, double end_x_m) {
  const auto index_at = [](double x_m) {
    return static_cast<std::int64_t>(std::floor(x_m / street_block_length_m));
  };
  while (!blocks_.empty() && blocks_.front().index < index_at(begin_x_m)) blocks_.pop_front();
  std::int64_t next = blocks_.empty() ? index_at(begin_x_m) : blocks_.back().index + 1;
  for (; next <= index_at(end_x_m); ++next) blocks_.push_back(make_street_block(road_, seed_, next));
}

}  // namespace pointreel::sim
