// How far a decoded cloud is from the original, as the field measures it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/nearest_points.h"
#include "pointreel/point_cloud.h"

namespace pointreel {

// A sweep with what comparing clouds with it needs: made once, used for every codec.
class ComparedSweep {
 public:
  // Positions are finite; the sweep outlives this.
  explicit ComparedSweep(const PointCloud& sweep);

  const std::vector<Point3f>& positions() const { return *positions_; }
  const NearestPoints& tree() const { return tree_; }
  // Of unit length, by the plane through the 12 nearest points; that of point i.
  const Point3f& normal(std::size_t i) const { return normals_[i]; }

 private:
  const std::vector<Point3f>* positions_;
  NearestPoints tree_;
  std::vector<Point3f> normals_;
};

// Distances of some points, from any number of sweeps.
struct Distances {
  std::vector<float> each_m;
  void merge(const Distances& other);
  double mean_m() const;
  double rms_m() const;
  double max_m() const;
  double p95_m() const;
};

struct CloudDifference {
  Distances own;               // each point to its own decoded point; empty where the order is not kept
  Distances to_decoded;        // each original point to the nearest decoded one
  Distances to_original;       // each decoded point to the nearest original one
  Distances to_decoded_plane;  // of both, the part along the original point's normal
  Distances to_original_plane;

  void merge(const CloudDifference& other);
  double largest_nearest_m() const;  // the larger maximum of the two directions
  double worse_rms_m() const;        // likewise
  // MPEG's D1 and D2: 10 log10(3 peak^2 / mse), the worse direction. Infinite where nothing differs.
  double d1_psnr_db(double peak_m) const;
  double d2_psnr_db(double peak_m) const;
};

// Each point to its own: both clouds have as many points, in one order.
Distances own_distances(const std::vector<Point3f>& original, const std::vector<Point3f>& decoded);

// The nearest ones both ways. `decoded` has a point.
CloudDifference nearest_differences(const ComparedSweep& original, const std::vector<Point3f>& decoded);

}  // namespace pointreel
