// Generated points for the tests of this folder.
#pragma once

#include <rapidcheck/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "pointreel/point_cloud.h"

namespace pointreel {

// Any floats at all, and coordinates of places nearby.
inline rc::Gen<std::vector<Point3f>> any_points() {
  const auto coordinate = rc::gen::map(rc::gen::arbitrary<std::uint32_t>(), [](std::uint32_t bits) {
    if (bits % 8 == 0) {
      float any;
      std::memcpy(&any, &bits, sizeof(any));
      return any;
    }
    return static_cast<float>(static_cast<std::int32_t>(bits) >> (bits % 31)) / 1024;
  });
  return rc::gen::container<std::vector<Point3f>>(
      rc::gen::build<Point3f>(rc::gen::set(&Point3f::x, coordinate), rc::gen::set(&Point3f::y, coordinate),
                              rc::gen::set(&Point3f::z, coordinate)));
}

}  // namespace pointreel
