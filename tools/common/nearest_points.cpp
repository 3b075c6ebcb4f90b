#include "common/nearest_points.h"

#include <cmath>
#include <nanoflann.hpp>

namespace pointreel {
struct NearestPoints::Tree {
  struct Source {
    std::span<const Point3f> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Source, double>,
                                                    Source, 3, std::uint32_t>;

  explicit Tree(std::span<const Point3f> points)
      : source{points}, index(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
  Source source;
  Index index;
};

NearestPoints::NearestPoints(std::span<const Point3f> points) : tree_(std::make_unique<Tree>(points)) {}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

NearestPoints::Neighbour NearestPoints::nearest(const Point3f& place) const {
  const float query[3] = {place.x, place.y, place.z};
  Neighbour neighbour;
  double squared_m2 = 0;
  tree_->index.knnSearch(query, 1, &neighbour.index, &squared_m2);
  neighbour.distance_m = std::sqrt(squared_m2);
  return neighbour;
}

std::vector<std::uint32_t> NearestPoints::nearest(const Point3f& place, std::size_t count) const {
  const float query[3] = {place.x, place.y, place.z};
  std::vector<std::uint32_t> indices(count);
  std::vector<double> squared_m2(count);
  indices.resize(tree_->index.knnSearch(query, count, indices.data(), squared_m2.data()));
  return indices;
}

}  // namespace pointreel
