#include "pointreel/sensor_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "base/parallel.h"
#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/io.h"
#include "pointreel/units.h"
#include "sensor/burst_sort.h"
#include "sensor/diagnosis.h"
#include "sensor/projection.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

constexpr std::size_t kMostSweeps = 20;  // evenly spread; more say nothing new

struct SensorFindings {
  std::size_t sweeps = 0, sweeps_given = 0, points = 0;
  std::optional<SensorModel> model;
  SensorDiagnosis diagnosis;
  std::size_t sweeps_in_order = 0;  // whose order of points the grid gives
};

Result<SensorFindings> find_sensor(const std::vector<std::filesystem::path>& paths) {
  SensorFindings findings;
  findings.sweeps_given = paths.size();
  findings.sweeps = std::min(paths.size(), kMostSweeps);
  GridOptions options;
  options.threads = resolve_threads(0);
  SensorEstimator estimator(options);
  std::vector<PointCloud> clouds;
  Progress progress("looking at", findings.sweeps);
  for (std::size_t i = 0; i < findings.sweeps; ++i) {
    auto cloud = read_cloud(paths[i * paths.size() / findings.sweeps]);
    if (!cloud) return cloud.error();
    undo_sort(*cloud);  // as the encoder does
    estimator.add(*cloud);
    findings.points += cloud->size();
    clouds.push_back(*std::move(cloud));
  }
  findings.model = estimator.model();
  if (!findings.model) return findings;
  std::vector<GriddedSweep> gridded;
  for (PointCloud& cloud : clouds) {
    gridded.push_back(project(*findings.model, cloud, options));
    findings.sweeps_in_order += gridded.back().grid.order.kind != OrderKind::none;
    cloud = {};
    progress.advance_to(gridded.size());
  }
  findings.diagnosis = diagnose(*findings.model, gridded);
  return findings;
}

struct Reason {
  StrayReason reason;
  std::string_view name, text;
};
constexpr std::array<Reason, 5> kReasons = {
    {{StrayReason::non_finite, "non_finite", "not finite"},
     {StrayReason::no_ray, "no_ray", "at the axis"},
     {StrayReason::off_row, "off_row", "between rows"},
     {StrayReason::off_column, "off_column", "between columns"},
     {StrayReason::collision, "collision", "in a cell that is taken"}}};

std::size_t points_of(const SensorDiagnosis& diagnosis, StrayReason reason) {
  return diagnosis.points_by_reason[static_cast<std::size_t>(reason)];
}

nlohmann::json rows_json(const SensorModel& model) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t r = 0; r < model.rows.size(); ++r) {
    const RowModel& row = model.rows[r];
    rows.push_back({{"elevation_deg", degrees(std::atan(row.slope))},
                    {"offset_m", row.offset_m},
                    {"azimuth_deg", degrees(row.azimuth_rad)},
                    {"side_offset_m", row.side_offset_m}});
    if (!model.ring_of_row.empty()) rows.back()["ring"] = model.ring_of_row[r];
  }
  return rows;
}

nlohmann::json to_json(const SensorFindings& findings, bool rows) {
  nlohmann::json json = {{"sweeps", findings.sweeps},
                         {"sweeps_given", findings.sweeps_given},
                         {"points", findings.points},
                         {"grid_found", findings.model.has_value()}};
  if (!findings.model) return json;
  const SensorDiagnosis& diagnosis = findings.diagnosis;
  nlohmann::json off_grid;
  for (const Reason& reason : kReasons)
    off_grid[std::string(reason.name)] = points_of(diagnosis, reason.reason);
  json.update({{"rows", diagnosis.rows},
               {"elevation_deg",
                {{"lowest", degrees(diagnosis.lowest_elevation_rad)},
                 {"highest", degrees(diagnosis.highest_elevation_rad)}}},
               {"offset_m", {{"lowest", diagnosis.lowest_offset_m}, {"highest", diagnosis.highest_offset_m}}},
               {"largest_side_offset_m", diagnosis.largest_side_offset_m},
               {"ticks_per_turn", diagnosis.ticks_per_turn},
               {"range_step_m", findings.model->range_step_m},
               {"has_rings", diagnosis.has_rings},
               {"motion_compensated", diagnosis.motion_compensated},
               {"columns_per_sweep", diagnosis.mean_columns},
               {"occupancy", diagnosis.occupancy},
               {"sweeps_in_order", findings.sweeps_in_order},
               {"points_on_grid", points_of(diagnosis, StrayReason::none)},
               {"points_off_grid", off_grid},
               {"residual_m",
                {{"p50", diagnosis.deviation.p50_m},
                 {"p95", diagnosis.deviation.p95_m},
                 {"p99", diagnosis.deviation.p99_m},
                 {"max", diagnosis.deviation.max_m}}}});
  if (rows) json["row_table"] = rows_json(*findings.model);
  return json;
}

void print_rows(const SensorModel& model) {
  fmt::print("\n  {:>5} {:>13} {:>11} {:>12} {:>16}\n", "row", "elevation deg", "offset mm", "azimuth deg",
             "side offset mm");
  for (std::size_t r = 0; r < model.rows.size(); ++r) {
    const RowModel& row = model.rows[r];
    fmt::print("  {:>5} {:>13.3f} {:>11.1f} {:>12.3f} {:>16.1f}\n", r, degrees(std::atan(row.slope)),
               1000 * row.offset_m, degrees(row.azimuth_rad), 1000 * row.side_offset_m);
  }
}

void print_findings(const SensorFindings& findings, bool rows) {
  const SensorDiagnosis& diagnosis = findings.diagnosis;
  fmt::print("{} of {} sweeps, {} points\n", findings.sweeps, findings.sweeps_given, findings.points);
  if (!findings.model) {
    fmt::print(
        "  no grid    not a rotating sensor's sweeps, or too few points; they are coded by an octree\n");
    return;
  }
  fmt::print("  rows       {} from {:.2f} to {:.2f} deg{}\n", diagnosis.rows,
             degrees(diagnosis.lowest_elevation_rad), degrees(diagnosis.highest_elevation_rad),
             diagnosis.has_rings ? ", told by the ring field" : "");
  fmt::print("  offsets    {:.1f} to {:.1f} mm up, {:.1f} mm sideways at most\n",
             1000 * diagnosis.lowest_offset_m, 1000 * diagnosis.highest_offset_m,
             1000 * diagnosis.largest_side_offset_m);
  fmt::print("  columns    {:.0f} a sweep, {}; {:.1f} % of the cells hold a point\n", diagnosis.mean_columns,
             diagnosis.ticks_per_turn > 0
                 ? fmt::format("on {} ticks a turn ({:.4f} deg)", diagnosis.ticks_per_turn,
                               360.0 / diagnosis.ticks_per_turn)
                 : std::string("on no common ticks"),
             100 * diagnosis.occupancy);
  fmt::print("  motion     {}\n",
             diagnosis.motion_compensated ? "compensated, and undone for the grid" : "not compensated");
  fmt::print("  order      given by the grid in {} of {} sweeps\n", findings.sweeps_in_order,
             findings.sweeps);
  fmt::print("  residual   {:.2f} mm from the ray (median), {:.2f} (95 %), {:.2f} (99 %), {:.2f} (max)\n",
             1000 * diagnosis.deviation.p50_m, 1000 * diagnosis.deviation.p95_m,
             1000 * diagnosis.deviation.p99_m, 1000 * diagnosis.deviation.max_m);
  std::string reasons;
  for (const Reason& reason : kReasons) {
    reasons +=
        fmt::format("{}{} {}", reasons.empty() ? "" : ", ", points_of(diagnosis, reason.reason), reason.text);
  }
  fmt::print("  off grid   {} points: {}\n", diagnosis.points - points_of(diagnosis, StrayReason::none),
             reasons);
  if (rows) print_rows(*findings.model);
}

}  // namespace

int report_sensor(const SensorReportArguments& arguments) {
  const auto paths = expand_inputs(arguments.inputs);
  if (!paths) {
    print_error(paths.error());
    return kFailed;
  }
  const auto findings = find_sensor(*paths);
  if (!findings) {
    print_error(findings.error());
    return kFailed;
  }
  if (arguments.json)
    fmt::print("{}\n", to_json(*findings, arguments.rows).dump(2));
  else
    print_findings(*findings, arguments.rows);
  return kDone;
}

}  // namespace pointreel
