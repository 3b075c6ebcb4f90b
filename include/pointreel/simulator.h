// A spinning LiDAR driven through a procedural street: sweeps, true poses, IMU. For tests, demos and
// benchmarks.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

enum class SensorKind : std::uint8_t { hdl_64e, vlp_16 };
Result<SensorKind> parse_sensor_kind(std::string_view name);  // "hdl-64e", "vlp-16"

struct SimulatorOptions {
  SensorKind sensor = SensorKind::hdl_64e;
  std::uint64_t seed = 1;        // the same seed gives the same bytes
  double sweep_rate_hz = 10;     // sweeps per second, 5 to 20
  double cruise_speed_mps = 8;   // reached after pulling away from rest, then kept within 20 %; 0 to 40
  double range_noise_m = 0.008;  // standard deviation on smooth surfaces, 0 to 1
  double drop_out = 0.02;        // share of shots on surfaces that give no return
};
// Error: invalid_argument, naming the option that is out of its range.
Result<void> validate(const SimulatorOptions& options);

struct SimulatedSweep {
  // KITTI order: rows top to bottom, each by azimuth 0 to 360 deg. Positions in whole millimetres. Field
  // "intensity": float, 0.00 to 0.99 by 0.01.
  PointCloud cloud;
  // Start of the sweep: the encoder passes 0. It turns evenly to the left, and all lasers fire together: each
  // column is measured at its own time, from where the sensor is then (not compensated).
  double time_s = 0;
  Pose T_world_sensor;  // true pose at time_s
};

class Simulator {
 public:
  // Needs options that validate() accepts. Sweeps take the same memory however long the drive.
  explicit Simulator(const SimulatorOptions& options);
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  SimulatedSweep next_sweep();
  // 100 Hz with white noise and constant bias, gravity included, from 1 s at rest before the first sweep to
  // the end of the last sweep made so far.
  std::vector<ImuSample> imu() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pointreel
