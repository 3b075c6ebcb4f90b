// Motions as they travel in a packet: a sweep's pose in its key frame, 24 bytes, and what a predicted frame
// of the sensor's grid has moved since its reference, 25 bytes.
#pragma once

#include "base/bytes.h"
#include "motion/sweep_motion.h"
#include "pointreel/motion.h"
#include "pointreel/result.h"

namespace pointreel {

// float32 quaternion x, y, z (w >= 0 follows from unit length) and translation in metres: 1e-7 rad and,
// within 100 m, 4 um.
void put_relative_pose(ByteWriter& writer, const Pose& T_key_sensor);
Result<Pose> get_relative_pose(ByteReader& reader);

// What get_relative_pose returns for put_relative_pose: both sides must use this pose.
Result<Pose> quantised(const Pose& T_key_sensor);

// The pose, and the motion per turn in 64ths as a signed byte.
void put_sweep_motion(ByteWriter& writer, const SweepMotion& motion);
Result<SweepMotion> get_sweep_motion(ByteReader& reader);
Result<SweepMotion> quantised(const SweepMotion& motion);

}  // namespace pointreel
