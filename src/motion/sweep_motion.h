// SweepMotion: from one sweep of a sensor that turns to the next.
#pragma once

#include "pointreel/motion.h"

namespace pointreel {

// The pose is that between two looks in the same direction. What the sensor passes it sees next in another
// direction, so not a whole sweep later: a surface at azimuth a_ref of the reference and a_cur of the current
// sweep, both in the sensor's axes, has moved by T_ref_cur.translation() (1 + per_turn sin(a_cur - a_ref) / 2
// pi). The sine is as good as the angle and needs no function but a root. What the sensor itself turns within
// this part of a turn is left out.
struct SweepMotion {
  Pose T_ref_cur = Pose::Identity();
  // Of the motion, what falls into one turn of the sensor counterclockwise, -1 to 1: 1 or -1 (clockwise)
  // where a sweep is a turn, a half of that where every second sweep is left out, 0 where all is seen at
  // once.
  double per_turn = 0;
};

}  // namespace pointreel
