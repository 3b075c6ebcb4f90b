#include "pointreel/simulator.h"

#include <algorithm>
#include <cmath>

#include "sim/imu_model.h"
#include "sim/random.h"
#include "sim/return_model.h"
#include "sim/scene.h"
#include "sim/sensor_geometry.h"
#include "sim/turn.h"
#include "sim/vehicle_motion.h"

namespace pointreel {
namespace {

using namespace sim;
using Eigen::Vector2d, Eigen::Vector3d;

// Which seed drives what.
enum SeedKey : std::uint64_t { road_key, scene_key, motion_key, imu_key, firing_key, sweep_key };

// The carrier's own roof, in sensor coordinates: beams that meet it are not reported.
bool meets_own_roof(const Vector3d& direction) {
  constexpr double below_m = 0.8, front_m = 1.85, rear_m = -2.3, half_width_m = 0.9;
  if (direction.z() >= 0) return false;
  const double range_m = below_m / -direction.z();
  const double x_m = range_m * direction.x(), y_m = range_m * direction.y();
  return x_m > rear_m && x_m < front_m && std::abs(y_m) < half_width_m;
}

// KITTI files hold whole millimetres. Never -0, whose azimuth would be -pi or 2 pi.
float to_millimetres(double v_m) {
  return static_cast<float>(std::round(v_m * 1000) / 1000 + 0.0);
}

struct MeasuredPoint {
  Point3f position;
  float intensity;
  double azimuth_rad;  // of the rounded position, 0 to 2 pi
};

MeasuredPoint make_point(const Ray& ray_sensor, const Return& received) {
  const Vector3d p = ray_sensor.origin_m + received.range_m * ray_sensor.direction;
  const Point3f position{to_millimetres(p.x()), to_millimetres(p.y()), to_millimetres(p.z())};
  const double azimuth_rad = std::atan2(double{position.y}, double{position.x});
  return {position, static_cast<float>(received.intensity),
          azimuth_rad < 0 ? azimuth_rad + two_pi : azimuth_rad};
}

// Points in the order of firing become a cloud in KITTI's order.
PointCloud assemble(std::vector<std::vector<MeasuredPoint>> rows) {
  PointCloud cloud;
  std::vector<float> intensity;
  for (std::vector<MeasuredPoint>& row : rows) {
    std::stable_sort(row.begin(), row.end(), [](const MeasuredPoint& a, const MeasuredPoint& b) {
      return a.azimuth_rad < b.azimuth_rad;
    });
    for (const MeasuredPoint& point : row) {
      cloud.positions.push_back(point.position);
      intensity.push_back(point.intensity);
    }
  }
  cloud.fields.push_back({"intensity", std::move(intensity)});
  return cloud;
}

}  // namespace

struct Simulator::Impl {
  explicit Impl(const SimulatorOptions& o) : options(o) {}

  double sweep_start_s(std::int64_t sweep) const {
    return static_cast<double>(sweep) / options.sweep_rate_hz;
  }
  std::uint64_t seed_for(SeedKey key) const { return combine(options.seed, key); }

  std::vector<int> next_firing_ticks();
  std::vector<std::vector<MeasuredPoint>> measure(double begin_s, double duration_s, Random& random);

  SimulatorOptions options;
  SensorGeometry sensor = make_sensor_geometry(options.sensor, options.sweep_rate_hz);
  Road road{seed_for(road_key)};
  VehicleMotion motion{road, options.cruise_speed_mps, seed_for(motion_key)};
  Scene scene{road, motion, std::max(options.cruise_speed_mps, 5.0), sensor.max_range_m, seed_for(scene_key)};

  std::int64_t sweeps_made = 0;
  double firing_position_ticks = 0;  // of the next firing, from the start of the next sweep
  Random firing_random{seed_for(firing_key)};
};

// The lasers fire at a fixed rate while the encoder turns: most steps are alike, some a tick shorter.
std::vector<int> Simulator::Impl::next_firing_ticks() {
  const double step = sensor.ticks_per_revolution * options.sweep_rate_hz / sensor.firings_per_s;
  std::vector<int> ticks;
  while (firing_position_ticks < sensor.ticks_per_revolution) {
    // The margin keeps whole steps whole after many additions.
    const auto tick = static_cast<int>(firing_position_ticks + 1e-6);
    if (ticks.empty() || tick > ticks.back()) ticks.push_back(tick);
    firing_position_ticks += step + sensor.firing_jitter_ticks * firing_random.normal();
  }
  firing_position_ticks -= sensor.ticks_per_revolution;
  return ticks;
}

// One revolution: the points of each row in the order of firing.
std::vector<std::vector<MeasuredPoint>> Simulator::Impl::measure(double begin_s, double duration_s,
                                                                 Random& random) {
  std::vector<std::vector<MeasuredPoint>> rows(sensor.lasers.size());
  for (const int tick : next_firing_ticks()) {
    const double turn = static_cast<double>(tick) / sensor.ticks_per_revolution;
    const double age_s = turn * duration_s;
    const Vector2d encoder(std::cos(turn * two_pi), std::sin(turn * two_pi));
    const Pose T_world_sensor = motion.state(begin_s + age_s).T_world_sensor;
    const double yaw_rad = std::atan2(T_world_sensor(1, 0), T_world_sensor(0, 0));
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const Laser& laser = sensor.lasers[row];
      const Ray ray = laser.beam(encoder);
      if (meets_own_roof(ray.direction)) continue;
      const Ray ray_world{T_world_sensor * ray.origin_m, T_world_sensor.linear() * ray.direction};
      const auto hit = scene.cast(ray_world, turn * two_pi + laser.rotation_rad() + yaw_rad, age_s);
      if (!hit) continue;
      const auto received = receive(*hit, options, random);
      if (!received) continue;
      if (received->range_m < sensor.min_range_m || received->range_m > sensor.max_range_m) continue;
      rows[row].push_back(make_point(ray, *received));
    }
  }
  return rows;
}

Result<SensorKind> parse_sensor_kind(std::string_view name) {
  if (name == "hdl-64e") return SensorKind::hdl_64e;
  if (name == "vlp-16") return SensorKind::vlp_16;
  return Error{ErrorCode::invalid_argument,
               "unknown sensor '" + std::string(name) + "': expected hdl-64e or vlp-16"};
}

Result<void> validate(const SimulatorOptions& options) {
  const auto outside = [](double v, double low, double high) { return !(v >= low && v <= high); };  // NaN too
  const auto error = [](const char* what) { return Error{ErrorCode::invalid_argument, what}; };
  if (outside(options.sweep_rate_hz, 5, 20)) return error("the sweep rate must be 5 to 20 Hz");
  if (outside(options.cruise_speed_mps, 0, 40)) return error("the cruise speed must be 0 to 40 m/s");
  if (outside(options.range_noise_m, 0, 1)) return error("the range noise must be 0 to 1 m");
  if (outside(options.drop_out, 0, 1)) return error("the share of drop-outs must be 0 to 1");
  return {};
}

Simulator::Simulator(const SimulatorOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

SimulatedSweep Simulator::next_sweep() {
  Impl& sim = *impl_;
  const std::int64_t number = sim.sweeps_made++;
  const double begin_s = sim.sweep_start_s(number), end_s = sim.sweep_start_s(number + 1);
  Random random(combine(sim.seed_for(sweep_key), static_cast<std::uint64_t>(number)));
  sim.scene.prepare(begin_s, end_s);
  return {assemble(sim.measure(begin_s, end_s - begin_s, random)), begin_s,
          sim.motion.state(begin_s).T_world_sensor};
}

std::vector<ImuSample> Simulator::imu() const {
  return simulate_imu(impl_->motion, impl_->sweep_start_s(impl_->sweeps_made), impl_->seed_for(imu_key));
}

}  // namespace pointreel
