// Writes the golden streams on the sensor's grid, with the digests of what they decode to.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "pointreel/simulator.h"
#include "support/sweep_digest.h"

namespace pointreel {
namespace {

constexpr double kSweepRateHz = 20;  // the fastest turn has the fewest columns

std::vector<SimulatedSweep> drive(SensorKind sensor, int sweeps) {
  SimulatorOptions options;
  options.sensor = sensor;
  options.sweep_rate_hz = kSweepRateHz;
  Simulator simulator(options);
  std::vector<SimulatedSweep> made;
  for (int i = 0; i < sweeps; ++i) made.push_back(simulator.next_sweep());
  return made;
}

// Share of the turn that had passed when the point was measured.
double turned(const Point3f& p) {
  const double azimuth_rad = std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
  return (azimuth_rad < 0 ? azimuth_rad + 2 * std::numbers::pi : azimuth_rad) / (2 * std::numbers::pi);
}

// The points `order` names, with their intensity.
PointCloud picked(const PointCloud& cloud, const std::vector<std::size_t>& order) {
  const auto& intensity = std::get<std::vector<float>>(cloud.find_field("intensity")->values);
  std::vector<float> picked_intensity;
  PointCloud result;
  for (const std::size_t i : order) {
    result.positions.push_back(cloud.positions[i]);
    picked_intensity.push_back(intensity[i]);
  }
  result.fields.push_back({"intensity", std::move(picked_intensity)});
  return result;
}

// Column after column as the sensor fires, with a ring and a time for each point.
PointCloud in_firing_order(const SimulatedSweep& sweep, int columns) {
  struct Shot {
    int column;
    std::uint16_t ring;
    std::size_t index;
  };
  std::vector<Shot> shots;
  std::uint16_t ring = 0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const double share = turned(sweep.cloud.positions[i]);
    if (i > 0 && share < turned(sweep.cloud.positions[i - 1]) - 0.5) ++ring;
    shots.push_back({static_cast<int>(std::lround(share * columns)) % columns, ring, i});
  }
  std::stable_sort(shots.begin(), shots.end(),
                   [](const Shot& a, const Shot& b) { return a.column < b.column; });
  std::vector<std::size_t> order;
  std::vector<std::uint16_t> rings;
  std::vector<double> times_s;
  for (const Shot& shot : shots) {
    order.push_back(shot.index);
    rings.push_back(shot.ring);
    times_s.push_back(sweep.time_s + shot.column / (kSweepRateHz * columns));
  }
  PointCloud cloud = picked(sweep.cloud, order);
  cloud.fields.push_back({"ring", std::move(rings)});
  cloud.fields.push_back({"timestamp", std::move(times_s)});
  return cloud;
}

// The sweep as seen from where the sensor was when it looked straight ahead, in the middle of a turn that
// began behind it. T_start_end: motion over a whole turn.
PointCloud compensated(PointCloud cloud, const Pose& T_start_end) {
  const std::vector<TimedPose> track = {{-1, T_start_end.inverse()}, {0, Pose::Identity()}, {1, T_start_end}};
  for (Point3f& p : cloud.positions) {
    const double share = turned(p);
    const Eigen::Vector3d moved =
        interpolate_pose(track, share > 0.5 ? share - 1 : share) * Eigen::Vector3d(p.x, p.y, p.z);
    p = {static_cast<float>(moved.x()), static_cast<float>(moved.y()), static_cast<float>(moved.z())};
  }
  return cloud;
}

// No order, no grid, some points far out or not finite.
PointCloud scattered(const PointCloud& sweep) {
  std::mt19937 random(1);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sweep.size(); i += 7) order.push_back(i);
  std::shuffle(order.begin(), order.end(), random);
  PointCloud cloud = picked(sweep, order);
  std::normal_distribution<float> shift_m(0, 1);
  for (Point3f& p : cloud.positions)
    p = {p.x + shift_m(random), p.y + shift_m(random), p.z + shift_m(random)};
  cloud.positions[10] = {3e8F, -2e7F, 1e-30F};
  cloud.positions[20].y = std::numeric_limits<float>::quiet_NaN();
  cloud.positions[30] = cloud.positions[31];
  return cloud;
}

bool write(const std::string& stem, const std::vector<PointCloud>& sweeps, const MixtureOptions& mixture,
           Method method = Method::mixture) {
  EncoderOptions options;
  options.method = method;
  options.mixture = mixture;
  auto encoder = Encoder::create(options);
  if (!encoder) return false;
  std::stringstream stream;
  auto writer = ReelWriter::create(stream, encoder->header());
  if (!writer) return false;
  const auto take = [&](const Result<std::vector<Packet>>& packets) {
    bool written = static_cast<bool>(packets);
    for (std::size_t i = 0; written && i < packets->size(); ++i)
      written = static_cast<bool>(writer->write((*packets)[i]));
    return written;
  };
  for (const PointCloud& sweep : sweeps) {
    if (!take(encoder->encode(sweep))) return false;
  }
  if (!take(encoder->finish()) || !writer->finish()) return false;
  std::ofstream(stem + ".reel", std::ios::binary) << stream.str();
  const auto digest = digest_of_reel(stream, stem);
  if (!digest) return false;
  std::ofstream(stem + ".txt", std::ios::binary) << *digest;
  std::printf("%s.reel: %zu bytes\n%s", stem.c_str(), stream.str().size(), digest->c_str());
  return true;
}

bool write_all(const std::string& folder) {
  const auto low = drive(SensorKind::vlp_16, 3);
  const auto high = drive(SensorKind::hdl_64e, 1);
  std::vector<PointCloud> firing;
  for (const SimulatedSweep& sweep : low) firing.push_back(in_firing_order(sweep, 900));
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() << 0.5, 0.01, 0;
  MixtureOptions fine, coarse;
  fine.max_error_m = 0.001;
  fine.group = 2;
  coarse.max_error_m = 0.02;
  coarse.fields.named = {{"intensity", 0.05}};
  MixtureOptions planes;
  planes.max_error_m = 0.1;
  MixtureOptions max;
  max.max_error_m = 0.02;
  max.effort = Effort::max;
  return write(folder + "/mixture_v1_firing_order", firing, fine) &&
         write(folder + "/mixture_v1_compensated", {compensated(high[0].cloud, motion)}, coarse) &&
         write(folder + "/mixture_v1_scattered", {scattered(low[0].cloud)}, coarse) &&
         write(folder + "/mixture_v1_max", {low[0].cloud, low[1].cloud, low[2].cloud}, max) &&
         write(folder + "/planes_v1_sensor", {low[0].cloud, low[1].cloud, low[2].cloud}, planes,
               Method::planes);
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_golden FOLDER\n");
    return 2;
  }
  return pointreel::write_all(argv[1]) ? 0 : 1;
}
