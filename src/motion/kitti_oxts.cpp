// KITTI's GPS/IMU folder. Of the 30 values we take
//   ax, ay, az and wx, wy, wz: the vehicle's own axes, as a strapped-down IMU measures. af, al, au and wf,
//   wl, wu are
//     the same readings levelled by roll and pitch, so they belong to no axes that are fixed to the sensor;
//   vf, vl, vu: levelled too ("parallel to the earth's surface") and given in no other way, hence roll and
//   pitch.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>

#include "motion/rotation.h"
#include "motion/text_lines.h"
#include "pointreel/motion.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;
using Vec3 = Eigen::Vector3d;

enum OxtsColumn : std::size_t { kRoll = 3, kPitch = 4, kVf = 8, kAx = 11, kWx = 17, kColumnCount = 30 };

// --- times ---

struct Timestamp {
  std::int64_t seconds =
      0;  // since 1970; apart from the fraction because a double holds no nanoseconds of today
  double fraction_s = 0;

  double operator-(const Timestamp& start) const {
    return static_cast<double>(seconds - start.seconds) + (fraction_s - start.fraction_s);
  }
};

// Takes an unsigned number of exactly `digits` digits, and the separator after it, off the front of `text`.
std::optional<int> take_number(std::string_view& text, std::size_t digits, std::string_view separator) {
  int value = 0;
  const char* const end = text.data() + std::min(digits, text.size());
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc{} || stop != text.data() + digits || value < 0) return std::nullopt;
  text.remove_prefix(digits);
  if (!text.starts_with(separator)) return std::nullopt;
  text.remove_prefix(separator.size());
  return value;
}

// "2011-09-26 13:02:25.964389445"
std::optional<Timestamp> parse_timestamp(std::string_view text) {
  const auto year = take_number(text, 4, "-");
  const auto month = year ? take_number(text, 2, "-") : year;
  const auto day = month ? take_number(text, 2, " ") : month;
  const auto hour = day ? take_number(text, 2, ":") : day;
  const auto minute = hour ? take_number(text, 2, ":") : hour;
  const auto second = minute ? take_number(text, 2, "") : minute;
  if (!second || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;

  Timestamp time;
  const std::chrono::sys_seconds whole_seconds = std::chrono::sys_days(date) + std::chrono::hours(*hour) +
                                                 std::chrono::minutes(*minute) +
                                                 std::chrono::seconds(*second);
  time.seconds = whole_seconds.time_since_epoch().count();
  if (!text.empty()) {
    const auto fraction_s = text.front() == '.' ? parse_number(text) : std::nullopt;
    if (!fraction_s || *fraction_s >= 1) return std::nullopt;
    time.fraction_s = *fraction_s;
  }
  return time;
}

struct NumberedTimestamp {
  std::size_t line_number = 0;
  Timestamp time;
};

Result<std::vector<NumberedTimestamp>> read_timestamps(const fs::path& path) {
  std::vector<NumberedTimestamp> times;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    const auto time = parse_timestamp(line.text);
    if (!time) return line.error("is no time like 2011-09-26 13:02:25.964389445");
    if (!times.empty() && *time - times.back().time <= 0) {
      return line.error("the time is not after that of the line before");
    }
    times.push_back({line.number, *time});
    return {};
  });
  if (!read) return read.error();
  if (times.empty()) return file_error(ErrorCode::truncated, path, "holds no times");
  return times;
}

// --- calibration ---

// The file next to the folder or in one of two folders above; empty where there is none.
fs::path find_calibration(const fs::path& folder) {
  std::error_code failure;
  fs::path parent = fs::absolute(folder / "..", failure).lexically_normal();
  for (int level = 0; level < 3; ++level) {
    fs::path candidate = parent / "calib_imu_to_velo.txt";
    if (fs::exists(candidate, failure)) return candidate;
    parent = (parent / "..").lexically_normal();
  }
  return {};
}

// Lines "R: 9 numbers" and "T: 3 numbers"; others (calib_time) are of no use here.
Result<Pose> read_calibration(const fs::path& path) {
  std::optional<std::vector<double>> rotation;
  std::optional<std::vector<double>> translation;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    if (!line.text.starts_with("R:") && !line.text.starts_with("T:")) return {};
    const bool is_rotation = line.text.front() == 'R';
    const TextLine values{line.path, line.number, line.text.substr(2)};
    auto numbers = parse_numbers(values, Separator::blanks, is_rotation ? 9 : 3);
    if (!numbers) return numbers.error();
    (is_rotation ? rotation : translation) = *std::move(numbers);
    return {};
  });
  if (!read) return read.error();
  if (!rotation || !translation) return file_error(ErrorCode::corrupt, path, "lacks a line R: or T:");

  Matrix34 matrix;
  matrix.leftCols<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation->data());
  matrix.col(3) = Eigen::Map<const Vec3>(translation->data());
  const std::optional<Pose> T_lidar_imu = pose_from_matrix(matrix);
  if (!T_lidar_imu) return file_error(ErrorCode::corrupt, path, "the matrix after R: is not a rotation");
  return *T_lidar_imu;
}

// --- samples ---

Result<std::vector<double>> read_values(const fs::path& path) {
  std::vector<double> values;
  const auto read = for_each_line(path, [&](const TextLine& line) -> Result<void> {
    if (!values.empty()) return line.error("a second line of values in a file of one");
    auto numbers = parse_numbers(line, Separator::blanks, kColumnCount);
    if (!numbers) return numbers.error();
    values = *std::move(numbers);
    return {};
  });
  if (!read) return read.error();
  if (values.empty()) return file_error(ErrorCode::truncated, path, "holds no values");
  return values;
}

Vec3 vector_at(const std::vector<double>& values, OxtsColumn first) {
  return {values[first], values[first + 1], values[first + 2]};
}

ImuSample sample_in_lidar_axes(const std::vector<double>& values, const Pose& T_lidar_imu) {
  const Eigen::Matrix3d R_level_imu =
      (Eigen::AngleAxisd(values[kPitch], Vec3::UnitY()) * Eigen::AngleAxisd(values[kRoll], Vec3::UnitX()))
          .toRotationMatrix();
  const Eigen::Matrix3d R_lidar_imu = T_lidar_imu.linear();
  // From the IMU to the LiDAR, in LiDAR axes: T_lidar_imu puts the IMU at its translation.
  const Vec3 lever_m = -T_lidar_imu.translation();

  ImuSample sample;
  sample.rotation_rate_radps = R_lidar_imu * vector_at(values, kWx);
  // The accelerations stay those of the IMU's place: the lever's share needs the derivative of the rotation
  // rate, which is mostly noise, and with velocities at hand nothing integrates them.
  sample.acceleration_mps2 = R_lidar_imu * vector_at(values, kAx);
  sample.velocity_mps = R_lidar_imu * (R_level_imu.transpose() * vector_at(values, kVf)) +
                        sample.rotation_rate_radps.cross(lever_m);
  return sample;
}

Result<std::vector<fs::path>> list_data_files(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (entry->path().extension() == ".txt") files.push_back(entry->path());
  }
  if (failure) return file_error(ErrorCode::io_error, folder, "cannot be listed");
  if (files.empty()) return file_error(ErrorCode::truncated, folder, "holds no .txt files");
  std::sort(files.begin(), files.end());  // KITTI pads the numbers with zeros
  return files;
}

// data/0000000007.txt belongs to line 8 of timestamps.txt, also where some files before it are missing.
std::optional<std::size_t> timestamp_line_of(const fs::path& data_file) {
  const std::string stem = data_file.stem().string();
  std::size_t number = 0;
  const auto [stop, status] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (status != std::errc{} || stop != stem.data() + stem.size()) return std::nullopt;
  return number + 1;
}

}  // namespace

Result<std::vector<ImuSample>> read_kitti_oxts(const std::filesystem::path& folder) {
  const fs::path timestamps_path = folder / "timestamps.txt";
  const auto times = read_timestamps(timestamps_path);
  if (!times) return times.error();
  const auto files = list_data_files(folder / "data");
  if (!files) return files.error();

  Pose T_lidar_imu = Pose::Identity();
  if (const fs::path calibration = find_calibration(folder); !calibration.empty()) {
    const auto calibrated = read_calibration(calibration);
    if (!calibrated) return calibrated.error();
    T_lidar_imu = *calibrated;
  }

  std::vector<ImuSample> samples;
  std::optional<Timestamp> start;
  for (const fs::path& file : *files) {
    const std::optional<std::size_t> line_number = timestamp_line_of(file);
    if (!line_number) return file_error(ErrorCode::corrupt, file, "is not named by a number");
    const auto time = std::lower_bound(
        times->begin(), times->end(), *line_number,
        [](const NumberedTimestamp& a, std::size_t wanted) { return a.line_number < wanted; });
    if (time == times->end() || time->line_number != *line_number) {
      return TextLine{timestamps_path, *line_number, {}}.error("no time for " + file.string());
    }
    const auto values = read_values(file);
    if (!values) return values.error();
    if (!start) start = time->time;
    samples.push_back(sample_in_lidar_axes(*values, T_lidar_imu));
    samples.back().time_s = time->time - *start;
    if (samples.size() > 1 && samples.back().time_s <= (samples.end() - 2)->time_s) {
      return file_error(ErrorCode::corrupt, file, "has the number of the file before");
    }
  }
  return samples;
}

}  // namespace pointreel
