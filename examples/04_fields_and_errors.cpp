// Fields travel with the points: exactly, within a step, or not at all. And what a mistake looks like.
#include <pointreel/pointreel.h>
#include <pointreel/simulator.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>
#include <variant>
#include <vector>

int main() {
  pointreel::Simulator simulator(pointreel::SimulatorOptions{.sensor = pointreel::SensorKind::vlp_16});
  pointreel::PointCloud sweep = simulator.next_sweep().cloud;  // brings a field "intensity"
  std::vector<double> times_s;
  for (std::size_t i = 0; i < sweep.size(); ++i) times_s.push_back(1e-6 * static_cast<double>(i));
  sweep.fields.push_back({"timestamp", std::move(times_s)});
  sweep.fields.push_back({"label", std::vector<std::uint8_t>(sweep.size(), 7)});

  pointreel::EncoderOptions options;
  options.mixture.fields.all_others = false;                               // leaves "label" out
  options.mixture.fields.named = {{"timestamp", 0}, {"intensity", 0.02}};  // to the bit; 0.02 off at most
  const auto bytes = pointreel::encode({&sweep, 1}, options);
  if (!bytes) return 1;
  const auto decoded = pointreel::decode(*bytes);
  if (!decoded || !decoded->front().order_kept) return 1;

  const auto& before = std::get<std::vector<float>>(sweep.find_field("intensity")->values);
  const auto& after = std::get<std::vector<float>>(decoded->front().cloud.find_field("intensity")->values);
  float most = 0;
  for (std::size_t i = 0; i < before.size(); ++i) most = std::max(most, std::fabs(after[i] - before[i]));
  std::printf("intensities are %.3f off at most\n", static_cast<double>(most));

  // Nothing throws and nothing is printed: the Error has a code for the program and a sentence for its user.
  options.mixture.max_error_m = -1;
  const auto refused = pointreel::encode({&sweep, 1}, options);
  const auto cut_off = pointreel::decode(std::span(*bytes).first(bytes->size() / 2));
  if (refused || cut_off) return 1;
  std::printf("%s\n%s\n", refused.error().message.c_str(), cut_off.error().message.c_str());
}
