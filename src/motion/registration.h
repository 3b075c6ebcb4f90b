// register_sweeps: the motion of the sensor between two sweeps, from their range images alone.
//
// Point-to-plane with projective association: patches of the current sweep's surfaces, moved by the pose so
// far, are compared with what the reference has in the same direction. A thousand patches; wide robust
// kernel first, narrow last. Any sensor with rows and columns will do. The result is the encoder's own: it
// travels in the stream, so nothing here needs to give the same bits on every machine.
#pragma once

#include <optional>

#include "motion/motion_per_turn.h"
#include "motion/range_grid.h"
#include "pointreel/motion.h"

namespace pointreel {

struct Registration {
  Pose T_ref_cur = Pose::Identity();  // the current sweep's coordinates to the reference's, as measured
  // False: do not trust the pose, which is then the guess (or no motion without one).
  bool converged = false;
  double inlier_share = 0;  // of the patches: those that find the reference within 10 cm of their planes
  double rms_m = 0;         // of the inliers' distances from the planes
  // Of the six degrees of freedom the one that fewest patches see, 1: all of them do. In a tunnel near 0:
  // there the guess is kept, and cannot be far wrong for what is seen.
  double weakest_share = 0;
  TurnEvidence turning;  // for MotionPerTurn
};

// Both sweeps uncompensated, as measured; a little better before coding than after. `guess`: a pose that may
// be near, such as the last motion of a vehicle that goes on, or that of a pose file. Without a good one
// displacements up to about 3 m and 5 degrees are found. Any grids and any guess give a finite pose.
// `motion_per_turn`: SweepMotion::per_turn.
Registration register_sweeps(const GridRays& reference, const GridRays& current,
                             const std::optional<Pose>& guess = {}, double motion_per_turn = 0);

inline Registration register_sweeps(const RangeGrid& reference, const RangeGrid& current,
                                    const std::optional<Pose>& guess = {}, double motion_per_turn = 0) {
  return register_sweeps(GridRays(reference), GridRays(current), guess, motion_per_turn);
}

}  // namespace pointreel
