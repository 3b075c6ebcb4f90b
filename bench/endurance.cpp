// endurance: a long simulated drive through encoder and decoder; checks every point of every sweep, and that
// memory does not grow.
//
//   endurance [--sweeps N] [--sensor vlp-16|hdl-64e] [--max-error METRES]
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "pointreel/codec.h"
#include "pointreel/exit_code.h"
#include "pointreel/simulator.h"
#include "require.h"

namespace pointreel {
namespace {

// Of this process, now, with what the allocator keeps for later given back.
double resident_mib() {
  malloc_trim(0);
  long pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

double largest_error_m(const PointCloud& original, const DecodedSweep& decoded, const StreamHeader& header) {
  double largest_m = 0;
  const auto pairs = require(pair_points(header, original, decoded));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] < 0) throw std::runtime_error(fmt::format("frame {}: point {} is lost", decoded.frame, i));
    const Point3f& p = original.positions[i];
    const Point3f& q = decoded.cloud.positions[static_cast<std::size_t>(pairs[i])];
    largest_m = std::max(largest_m, std::hypot(static_cast<double>(p.x) - q.x, static_cast<double>(p.y) - q.y,
                                               static_cast<double>(p.z) - q.z));
  }
  return largest_m;
}

int drive(int sweeps, const std::string& sensor, double max_error_m) {
  SimulatorOptions drive;
  drive.sensor = require(parse_sensor_kind(sensor));
  Simulator simulator(drive);
  EncoderOptions options;
  options.mixture.max_error_m = max_error_m;
  auto encoder = require(Encoder::create(options));
  auto decoder = require(Decoder::create(encoder.header()));
  double settled_mib = 0, most_mib = 0, largest_m = 0, bits = 0, points = 0;
  constexpr int kSettled = 100;
  for (int i = 0; i < sweeps; ++i) {
    const PointCloud cloud = simulator.next_sweep().cloud;
    const auto packets = require(encoder.encode(cloud));
    for (const Packet& packet : packets) bits += 8.0 * static_cast<double>(packet.payload.size());
    points += static_cast<double>(cloud.size());
    for (auto& decoded : decoder.decode(packets))
      largest_m = std::max(largest_m, largest_error_m(cloud, require(std::move(decoded)), encoder.header()));
    if (i + 1 == kSettled) settled_mib = resident_mib();
    if (i + 1 > kSettled && (i + 1) % 100 == 0) most_mib = std::max(most_mib, resident_mib());
    if ((i + 1) % 1000 == 0)
      fmt::print("{} sweeps: {:.1f} MiB, largest error {:.5f} m\n", i + 1, resident_mib(), largest_m);
    std::fflush(stdout);
  }
  fmt::print("{} sweeps, {:.0f} points, {:.3f} bits per point; largest error {:.5f} m of {:g} m allowed\n",
             sweeps, points, bits / points, largest_m, max_error_m);
  fmt::print("memory: {:.1f} MiB after {} sweeps, at most {:.1f} MiB later\n", settled_mib, kSettled,
             most_mib);
  const bool grown = sweeps > kSettled && most_mib > 1.1 * settled_mib + 1;
  if (grown) fmt::print("memory has grown\n");
  return largest_m <= max_error_m && !grown ? kDone : kFailed;
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  int sweeps = 10'000;
  std::string sensor = "vlp-16";
  double max_error_m = 0.02;
  CLI::App app("A long simulated drive through encoder and decoder, every point checked");
  app.add_option("--sweeps", sweeps, "How many")->capture_default_str();
  app.add_option("--sensor", sensor, "vlp-16 or hdl-64e")->capture_default_str();
  app.add_option("--max-error", max_error_m, "Metres")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return pointreel::drive(sweeps, sensor, max_error_m);
  } catch (const std::exception& error) {
    fmt::print(stderr, "endurance: {}\n", error.what());
    return pointreel::kFailed;
  }
}
