#include "study_tables.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/parallel.h"

namespace pointreel {
namespace {

// A line of a table in the making: names and values side by side, so that neither can slip.
class Row {
 public:
  template <class Value>
  Row& add(std::string_view name, const Value& value) {
    if (!names_.empty()) names_ += ',', values_ += ',';
    names_ += name;
    if constexpr (std::is_floating_point_v<Value>) {
      values_ += fmt::format("{:.6g}", value);
    } else {
      values_ += fmt::format("{}", value);
    }
    return *this;
  }
  const std::string& names() const { return names_; }
  const std::string& values() const { return values_; }

 private:
  std::string names_, values_;
};

class CsvFile {
 public:
  explicit CsvFile(std::filesystem::path path) : path_(std::move(path)), file_(path_) {}

  void write(const Row& row) {
    if (!std::exchange(has_header_, true)) file_ << row.names() << '\n';
    file_ << row.values() << std::endl;  // flushed, so that failing shows here
    if (!file_) throw std::runtime_error(path_.string() + ": cannot write");
  }

 private:
  std::filesystem::path path_;
  std::ofstream file_;
  bool has_header_ = false;
};

std::string_view to_string(ResidualMode mode) {
  return mode == ResidualMode::raw_float ? "raw" : "auto";
}

double bits_per_point(const Measurement& measurement, const SweepSet& set) {
  return 8.0 * static_cast<double>(measurement.bytes) / static_cast<double>(set.points);
}

double degrees(double angle_rad) {
  return angle_rad * 180 / std::numbers::pi;
}

void add_setting(Row& row, const Setting& setting, const SweepSet& set, int repeats) {
  const PlanesOptions& planes = setting.planes;
  row.add("mode", planes.group == 1 ? "single-frame" : "streaming")
      .add("group", planes.group)
      .add("threshold_m", planes.threshold_m)
      .add("azimuth_step_deg", degrees(planes.azimuth_step_rad))
      .add("elevation_step_deg", degrees(planes.elevation_step_rad))
      .add("tile", planes.tile_size)
      .add("residual", to_string(planes.residual_mode))
      .add("motion", to_string(setting.motion))
      .add("threads", resolve_threads(setting.threads))
      .add("sweeps", set.sweeps.size())
      .add("repeats", repeats);
}

void add_rate(Row& row, const Measurement& measurement, const SweepSet& set) {
  const auto points = static_cast<double>(set.points);
  const double bpp = bits_per_point(measurement, set);
  const FrameStatistics& parts = measurement.parts;
  const double parts_bpp = (parts.occupancy_bits + parts.plane_bits + parts.residual_bits) / points;
  row.add("points", set.points)
      .add("bytes", measurement.bytes)
      .add("bpp", bpp)
      .add("ratio_xyz32", 96 / bpp)
      .add("occupancy_bpp", parts.occupancy_bits / points)
      .add("planes_bpp", parts.plane_bits / points)
      .add("residual_bpp", parts.residual_bits / points)
      .add("container_bpp", bpp - parts_bpp);
  const double cells = static_cast<double>(parts.spatial_cells) + parts.temporal_cells + parts.unfit_cells;
  row.add("spatial_share", parts.spatial_cells / cells)
      .add("temporal_share", parts.temporal_cells / cells)
      .add("unfit_share", parts.unfit_cells / cells);
}

void add_errors(Row& row, const Measurement& measurement) {
  const SweepQuality& quality = measurement.quality;
  row.add("kept_share", static_cast<double>(quality.paired.count) / static_cast<double>(quality.points_in))
      .add("mean_error_m", quality.paired.mean_m())
      .add("rms_error_m", quality.paired.rms_m())
      .add("max_error_m", quality.paired.max_m)
      .add("mean_range_error_m", quality.paired_range.mean_m())
      .add("max_range_error_m", quality.paired_range.max_m)
      .add("range_bound_m", measurement.range_bound_m)
      .add("mean_angular_rounding_m", quality.paired_angular.mean_m())
      .add("nearest_sweeps", measurement.nearest_sweeps)
      .add("nearest_decoded_mean_m", quality.nearest_decoded.mean_m())
      .add("nearest_decoded_max_m", quality.nearest_decoded.max_m)
      .add("nearest_original_mean_m", quality.nearest_original.mean_m())
      .add("nearest_original_max_m", quality.nearest_original.max_m);
}

void add_times(Row& row, const SweepTimes& times) {
  row.add("encode_ms", times.encode_ms)
      .add("decode_ms", times.decode_ms)
      .add("encode_sweeps_per_s", 1000 / times.encode_ms)
      .add("decode_sweeps_per_s", 1000 / times.decode_ms);
}

// Over the passes, encoding and decoding each by itself.
SweepTimes median(const std::vector<SweepTimes>& passes) {
  std::vector<double> encode_ms, decode_ms;
  for (const SweepTimes& pass : passes) {
    encode_ms.push_back(pass.encode_ms);
    decode_ms.push_back(pass.decode_ms);
  }
  return {quantile(std::move(encode_ms), 0.5), quantile(std::move(decode_ms), 0.5)};
}

// What a study that runs for minutes says meanwhile.
void report(std::string_view table, const Setting& setting, const std::string& result) {
  const PlanesOptions& planes = setting.planes;
  fmt::print("{:<10} group {:>2}, {:g} m, {:.2f} x {:.2f} deg, tile {:>2}, residual {}, motion {}: {}\n",
             table, planes.group, planes.threshold_m, degrees(planes.azimuth_step_rad),
             degrees(planes.elevation_step_rad), planes.tile_size, to_string(planes.residual_mode),
             to_string(setting.motion), result);
  std::fflush(stdout);
}

}  // namespace

void write_series(const Series& series, const SweepSet& set, const StudyOptions& options) {
  const int passes = series.timed ? options.repeats : 1;
  std::vector<Measurement> measurements;
  std::vector<std::vector<SweepTimes>> times;
  for (const Setting& setting : series.settings) {
    const Measurement& measurement = measurements.emplace_back(measure(set, setting, options.nearest_sweeps));
    times.push_back({measurement.times});
    report(
        series.name, setting,
        fmt::format("{:.3f} bpp, {:.1f} ms", bits_per_point(measurement, set), measurement.times.encode_ms));
  }
  // Setting after setting in each pass, not pass after pass of a setting: slow phases of the machine spread.
  for (int pass = 1; pass < passes; ++pass) {
    for (std::size_t i = 0; i < times.size(); ++i) times[i].push_back(measure_times(set, series.settings[i]));
  }
  CsvFile file(options.folder / fmt::format("{}.csv", series.name));
  for (std::size_t i = 0; i < times.size(); ++i) {
    Row row;
    add_setting(row, series.settings[i], set, passes);
    add_rate(row, measurements[i], set);
    add_errors(row, measurements[i]);
    add_times(row, median(times[i]));
    file.write(row);
  }
}

void write_speedup(const std::vector<Setting>& settings, const SweepSet& set, const StudyOptions& options) {
  CsvFile file(options.folder / "speedup.csv");
  for (const Setting& setting : settings) {
    Setting one_thread = setting;
    one_thread.threads = 1;
    std::vector<SweepTimes> alone, together;
    std::vector<double> encode_ratios, decode_ratios;
    for (int pass = 0; pass < options.repeats; ++pass) {
      alone.push_back(measure_times(set, one_thread));
      together.push_back(measure_times(set, setting));
      encode_ratios.push_back(alone.back().encode_ms / together.back().encode_ms);
      decode_ratios.push_back(alone.back().decode_ms / together.back().decode_ms);
    }
    const double encode_speedup = quantile(std::move(encode_ratios), 0.5);
    const double decode_speedup = quantile(std::move(decode_ratios), 0.5);
    Row row;
    add_setting(row, setting, set, options.repeats);
    row.add("encode_speedup", encode_speedup)
        .add("decode_speedup", decode_speedup)
        .add("encode_ms_one_thread", median(alone).encode_ms)
        .add("decode_ms_one_thread", median(alone).decode_ms);
    add_times(row, median(together));
    file.write(row);
    report("speedup", setting,
           fmt::format("{} threads, encode {:.2f}x, decode {:.2f}x", resolve_threads(setting.threads),
                       encode_speedup, decode_speedup));
  }
}

}  // namespace pointreel
