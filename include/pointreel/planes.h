// The planes that method `planes` found in a sweep, and what they tell of the sensor's motion.
//
//   for (const auto& planes : decoder->decode_planes(packets)) use(planes->planes);   // codec.h
//   const auto motion = register_planes(*earlier, *later);
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/result.h"

namespace pointreel {

// A piece of a plane: the cells of the sensor's grid that lie on it come in tiles. A cell's return, if it has
// one, is where its ray meets the plane. Which cells have one is not known without decoding the ranges: the
// format's hit mask is coded by what they are (docs/FORMAT.md, 8.1). So there are cells here, but no points.
struct PlaneTile {
  std::uint32_t plane = 0;            // index in SweepPlanes::planes
  std::uint32_t row = 0, column = 0;  // its first cell, in the image of the format's section 7.3
  std::uint32_t cells = 0;            // with or without a return; a full tile has 2 x 8
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();  // where its middle ray meets the plane
};

// All points p of the sweep on these cells have |normal . p - distance_m| at most about the stream's bound.
struct SweepPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of unit length, away from the sensor
  double distance_m = 0;                             // from the sensor
  bool reused = false;                               // the normal was that of a plane of the sweep before
  // No more points lie on it than it has cells.
  std::uint32_t tiles = 0, cells = 0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();   // mean of its tiles' centers
  Eigen::Vector3d long_axis = Eigen::Vector3d::Zero();  // both of unit length, along the plane
  Eigen::Vector3d short_axis = Eigen::Vector3d::Zero();
  double length_m = 0, width_m = 0;  // from the first to the last of its tiles' centers along the axes
};

// In the sensor's coordinates as measured, before any motion compensation.
struct SweepPlanes {
  std::uint32_t frame = 0;
  std::vector<SweepPlane> planes;  // in raster order of their first tiles
  std::vector<PlaneTile> tiles;    // in raster order
};

struct PlaneRegistration {
  Pose T_ref_cur = Pose::Identity();  // the later sweep's coordinates to the earlier one's
  double inlier_share = 0;            // of the tiles compared: those within 10 cm of the other sweep's planes
  double rms_m = 0;                   // of their distances
  // Of the six degrees of freedom the one that fewest tiles see, 1: all of them do.
  double weakest_share = 0;
};

// The motion between two sweeps from their planes alone: no point is decoded. `guess`: a pose that may be
// near, such as the last motion; without one displacements up to about 3 m and 5 degrees are found. Error
// invalid_argument: too few planes constrain the motion, or they do not agree.
Result<PlaneRegistration> register_planes(const SweepPlanes& reference, const SweepPlanes& current,
                                          const std::optional<Pose>& guess = {});

}  // namespace pointreel
