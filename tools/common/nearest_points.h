// NearestPoints: which point of a cloud is nearest to any place.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pointreel/point_cloud.h"

namespace pointreel {

class NearestPoints {
 public:
  // `points` are finite and outlive this.
  explicit NearestPoints(std::span<const Point3f> points);
  ~NearestPoints();
  NearestPoints(const NearestPoints&) = delete;
  NearestPoints& operator=(const NearestPoints&) = delete;
  NearestPoints(NearestPoints&&) noexcept;
  NearestPoints& operator=(NearestPoints&&) noexcept;

  struct Neighbour {
    std::uint32_t index = 0;
    double distance_m = 0;
  };
  // There must be a point.
  Neighbour nearest(const Point3f& place) const;
  // Up to `count` of them, the nearest first.
  std::vector<std::uint32_t> nearest(const Point3f& place, std::size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace pointreel
