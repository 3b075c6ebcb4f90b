// IMU samples as comma-separated text.
#include <algorithm>
#include <array>
#include <utility>

#include "motion/text_lines.h"
#include "pointreel/motion.h"

namespace pointreel {
namespace {

constexpr std::array<std::string_view, 10> kColumns{"t",  "ax", "ay", "az", "wx",
                                                    "wy", "wz", "vx", "vy", "vz"};
constexpr std::size_t kColumnsWithoutVelocity = 7;

bool is_header(const TextLine& line) {
  const auto words = split(line.text, Separator::comma);
  return std::none_of(words.begin(), words.end(), [](auto word) { return parse_number(word).has_value(); });
}

// Any wording is fine ("time [s]"), but a name of ours in another place means that the columns are swapped.
Result<void> check_header(const TextLine& line) {
  const auto words = split(line.text, Separator::comma);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto column =
        static_cast<std::size_t>(std::find(kColumns.begin(), kColumns.end(), words[k]) - kColumns.begin());
    if (column != kColumns.size() && column != k) {
      return line.error("column " + std::string(words[k]) +
                        " is not where t,ax,ay,az,wx,wy,wz,vx,vy,vz has it");
    }
  }
  return {};
}

Result<ImuSample> parse_sample(const TextLine& line) {
  const auto numbers = parse_numbers(line, Separator::comma);
  if (!numbers) return numbers.error();
  const std::vector<double>& n = *numbers;
  if (n.size() != kColumnsWithoutVelocity && n.size() != kColumns.size()) {
    return line.error("has " + std::to_string(n.size()) + " columns where 7 or 10 are needed");
  }
  ImuSample sample;
  sample.time_s = n[0];
  sample.acceleration_mps2 = Eigen::Vector3d(n[1], n[2], n[3]);
  sample.rotation_rate_radps = Eigen::Vector3d(n[4], n[5], n[6]);
  if (n.size() == kColumns.size()) sample.velocity_mps = Eigen::Vector3d(n[7], n[8], n[9]);
  return sample;
}

void append_vector(std::string& text, const Eigen::Vector3d& v) {
  for (const double value : v) {
    text += ',';
    append_number(text, value);
  }
}

}  // namespace

Result<std::vector<ImuSample>> read_imu_csv(const std::filesystem::path& path) {
  std::vector<ImuSample> samples;
  bool first_line = true;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    if (std::exchange(first_line, false) && is_header(line)) return check_header(line);
    const auto sample = parse_sample(line);
    if (!sample) return sample.error();
    if (!samples.empty() && sample->time_s <= samples.back().time_s) {
      return line.error("the time is not after that of the sample before");
    }
    samples.push_back(*sample);
    return {};
  });
  if (!read) return read.error();
  if (samples.empty()) return file_error(ErrorCode::truncated, path, "holds no IMU samples");
  return samples;
}

Result<void> write_imu_csv(const std::filesystem::path& path, std::span<const ImuSample> samples) {
  const bool with_velocity = std::any_of(samples.begin(), samples.end(), [](const ImuSample& sample) {
    return sample.velocity_mps.has_value();
  });
  std::string text = with_velocity ? "t,ax,ay,az,wx,wy,wz,vx,vy,vz\n" : "t,ax,ay,az,wx,wy,wz\n";
  for (const ImuSample& sample : samples) {
    append_number(text, sample.time_s);
    append_vector(text, sample.acceleration_mps2);
    append_vector(text, sample.rotation_rate_radps);
    if (sample.velocity_mps) append_vector(text, *sample.velocity_mps);
    text += '\n';
  }
  return write_text_file(path, text);
}

}  // namespace pointreel
