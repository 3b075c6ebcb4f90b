#include "codec/relative_pose.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace pointreel {
namespace {

constexpr double kPartsOfMotion = 64;

}  // namespace

void put_relative_pose(ByteWriter& writer, const Pose& T_key_sensor) {
  Eigen::Quaterniond q(T_key_sensor.linear());
  q.normalize();
  const double sign = q.w() < 0 ? -1 : 1;
  for (const double v : {sign * q.x(), sign * q.y(), sign * q.z()}) writer.put(static_cast<float>(v));
  for (int i = 0; i < 3; ++i) writer.put(static_cast<float>(T_key_sensor.translation()(i)));
}

Result<Pose> get_relative_pose(ByteReader& reader) {
  double v[6];
  for (double& value : v) value = reader.get<float>();
  if (!reader.ok()) return Error{ErrorCode::truncated, "the frame's payload ends within its pose"};
  const double x = v[0], y = v[1], z = v[2];
  const double w2 = 1.0 - (x * x + y * y + z * z);
  // Rounding to float can leave a half turn at most 1e-6 outside.
  if (!(w2 > -1e-6) || !std::isfinite(v[3]) || !std::isfinite(v[4]) || !std::isfinite(v[5])) {
    return Error{ErrorCode::corrupt, "the frame's pose is not a rigid motion"};
  }
  const double w = w2 > 0 ? std::sqrt(w2) : 0.0;
  Pose pose = Pose::Identity();
  pose.linear() << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),               //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  pose.translation() << v[3], v[4], v[5];
  return pose;
}

Result<Pose> quantised(const Pose& T_key_sensor) {
  ByteWriter writer;
  put_relative_pose(writer, T_key_sensor);
  ByteReader reader(writer.bytes());
  return get_relative_pose(reader);
}

void put_sweep_motion(ByteWriter& writer, const SweepMotion& motion) {
  put_relative_pose(writer, motion.T_ref_cur);
  writer.put(static_cast<std::int8_t>(std::lround(kPartsOfMotion * std::clamp(motion.per_turn, -1.0, 1.0))));
}

Result<SweepMotion> get_sweep_motion(ByteReader& reader) {
  auto pose = get_relative_pose(reader);
  if (!pose) return pose.error();
  const auto parts = reader.get<std::int8_t>();
  if (!reader.ok()) return Error{ErrorCode::truncated, "the frame's payload ends within its motion"};
  if (std::abs(parts) > kPartsOfMotion)
    return Error{ErrorCode::corrupt, "the frame's motion per turn is more than all of its motion"};
  return SweepMotion{*std::move(pose), parts / kPartsOfMotion};
}

Result<SweepMotion> quantised(const SweepMotion& motion) {
  ByteWriter writer;
  put_sweep_motion(writer, motion);
  ByteReader reader(writer.bytes());
  return get_sweep_motion(reader);
}

}  // namespace pointreel
