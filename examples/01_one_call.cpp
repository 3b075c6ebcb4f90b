// A drive in one call to bytes, and in another back to points.
#include <pointreel/pointreel.h>
#include <pointreel/simulator.h>

#include <cstdio>
#include <vector>

int main() {
  // Your own sweeps go here: positions in metres, in the sensor's coordinates. read_cloud() of io.h reads
  // files.
  pointreel::Simulator simulator(pointreel::SimulatorOptions{.sensor = pointreel::SensorKind::vlp_16});
  std::vector<pointreel::PointCloud> sweeps;
  for (int i = 0; i < 5; ++i) sweeps.push_back(simulator.next_sweep().cloud);

  pointreel::EncoderOptions options;
  options.mixture.max_error_m = 0.02;  // how far a decoded point may be from where it was

  // A Result holds the value or an Error that says in one sentence what is wrong.
  const auto bytes = pointreel::encode(sweeps, options);
  if (!bytes) {
    std::fprintf(stderr, "%s\n", bytes.error().message.c_str());
    return 1;
  }
  const auto decoded = pointreel::decode(*bytes);
  if (!decoded) {
    std::fprintf(stderr, "%s\n", decoded.error().message.c_str());
    return 1;
  }

  std::size_t points = 0;
  for (const auto& sweep : *decoded) points += sweep.cloud.size();
  std::printf("%zu sweeps, %zu points: %.2f bits a point\n", decoded->size(), points,
              8.0 * static_cast<double>(bytes->size()) / static_cast<double>(points));
}
