// A sweep's pose in its key frame as it travels in a packet: 24 bytes.
#pragma once

#include "base/bytes.h"
#include "pointreel/motion.h"
#include "pointreel/result.h"

namespace pointreel {

// float32 quaternion x, y, z (w >= 0 follows from unit length) and translation in metres: 1e-7 rad and,
// within 100 m, 4 um.
void put_relative_pose(ByteWriter& writer, const Pose& T_key_sensor);
Result<Pose> get_relative_pose(ByteReader& reader);

// What get_relative_pose returns for put_relative_pose: both sides must use this pose.
Result<Pose> quantised(const Pose& T_key_sensor);

}  // namespace pointreel
