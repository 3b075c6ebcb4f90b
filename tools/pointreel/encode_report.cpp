#include "pointreel/encode_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "common/frame_totals.h"
#include "common/quality.h"
#include "pointreel/field_choice.h"
#include "pointreel/units.h"

namespace pointreel {
namespace {

using Parts = std::vector<std::pair<std::string_view, double>>;  // bits

// Without the container, which has the rest.
Parts parts_of(const FrameStatistics& parts, const StreamHeader& header) {
  if (!header.on_sensor_grid()) {
    return {
        {"occupancy", parts.occupancy_bits}, {"planes", parts.plane_bits}, {"residual", parts.residual_bits}};
  }
  Parts all = {{"model", parts.model_bits},         {"grid", parts.grid_bits},
               {"occupancy", parts.occupancy_bits}, {"ranges", parts.range_bits},
               {"order", parts.order_bits},         {"corrections", parts.correction_bits},
               {"strays", parts.stray_bits},        {"scattered", parts.scattered_bits},
               {"fields", parts.field_bits}};
  if (header.method == Method::planes) all.insert(all.begin() + 3, {"planes", parts.plane_bits});
  return all;
}

// Rates of an encoded drive.
class Rates {
 public:
  explicit Rates(const EncodeTotals& totals)
      : points_(static_cast<double>(totals.points)),
        bits_(8.0 * static_cast<double>(totals.bytes)),
        geometry_bits_(bits_ - totals.parts.field_bits) {}

  double bits() const { return bits_; }
  double per_point(double bits) const { return points_ == 0 ? 0 : bits / points_; }
  double geometry() const { return per_point(geometry_bits_); }
  double ratio_xyz32() const { return geometry_bits_ == 0 ? 0 : 96 * points_ / geometry_bits_; }

 private:
  double points_, bits_, geometry_bits_;
};

std::uint64_t points_lost(const EncodeTotals& totals) {
  return totals.points - totals.points_out - totals.non_finite;
}

std::vector<std::string> fields_left_out(const EncodeTotals& totals, const StreamHeader& header,
                                         const FieldSelection& fields) {
  std::vector<std::string> names;
  for (const std::string& name : totals.fields) {
    if (!header.on_sensor_grid() || !keeps(fields, name)) names.push_back(name);
  }
  return names;
}

nlohmann::json sensor_grid_json(const EncodeTotals& totals, const StreamHeader& header,
                                const FieldSelection& fields, const Rates& rates) {
  nlohmann::json kept = nlohmann::json::object();
  for (const std::string& name : totals.fields) {
    const FieldStep* named = fields.find(name);
    if (keeps(fields, name)) kept[name] = {{"step", named == nullptr ? 0 : named->step}};
  }
  return {{"max_error_m", header.max_error_m},
          {"bits_per_point_with_fields", rates.per_point(rates.bits())},
          {"corrected_points", totals.parts.corrected_points},
          {"stray_points", totals.parts.stray_points},
          {"scattered_sweeps", totals.scattered_sweeps},
          {"fields", kept}};
}

nlohmann::json cells_json(const EncodeTotals& totals) {
  return {{"cells",
           {{"spatial", totals.parts.spatial_cells},
            {"temporal", totals.parts.temporal_cells},
            {"unfit", totals.parts.unfit_cells}}},
          {"plane_runs", totals.parts.runs}};
}

void print_cells(std::FILE* out, const EncodeTotals& totals, const char* reused) {
  const double cells = std::max(1.0, static_cast<double>(totals.points_out));
  fmt::print(out, "  cells           {:.1f} % on own planes, {:.1f} % on {}, {:.1f} % unfit\n",
             100 * totals.parts.spatial_cells / cells, 100 * totals.parts.temporal_cells / cells, reused,
             100 * totals.parts.unfit_cells / cells);
}

void print_uniform_grid(std::FILE* out, const EncodeTotals& totals, const StreamHeader& header,
                        const Rates& rates) {
  fmt::print(out, "  bits per point  occupancy {:.3f}, planes {:.3f}, residual map {:.3f}\n",
             rates.per_point(totals.parts.occupancy_bits), rates.per_point(totals.parts.plane_bits),
             rates.per_point(totals.parts.residual_bits));
  print_cells(out, totals, "the key frame's");
  fmt::print(out, "  points          {} kept, {} lost to nearer ones in the same cell, {} not finite\n",
             totals.points_out, points_lost(totals), totals.non_finite);
  fmt::print(out, "  range error     at most {:g} m for kept points, plus rounding to the cells' angles\n",
             header.bound_m());
}

void print_sensor_grid(std::FILE* out, const EncodeTotals& totals, const StreamHeader& header,
                       const FieldSelection& fields, const Rates& rates) {
  std::string parts;
  for (const auto& [name, bits] : parts_of(totals.parts, header)) {
    if (bits == 0 || name == "fields") continue;
    parts += fmt::format("{}{} {:.3f}", parts.empty() ? "" : ", ", name, rates.per_point(bits));
  }
  fmt::print(out, "  bits per point  {}\n", parts);
  if (header.method == Method::planes) print_cells(out, totals, "those of the sweep before");
  fmt::print(out, "  points          {} kept, {} not finite; {} off the sensor's grid, {} corrected\n",
             totals.points_out, totals.non_finite, totals.parts.stray_points, totals.parts.corrected_points);
  if (totals.scattered_sweeps > 0) {
    fmt::print(out, "  without a grid  {} sweeps of no rotating sensor; their points change places\n",
               totals.scattered_sweeps);
  }
  fmt::print(out, "  error           at most {:g} m in space for every point\n", header.bound_m());
  std::vector<std::string> kept;
  for (const std::string& name : totals.fields) {
    if (keeps(fields, name)) kept.push_back(describe_field(fields, name));
  }
  if (kept.empty()) return;
  fmt::print(out, "  fields          {}: {:.3f} bits per point more\n", fmt::join(kept, ", "),
             rates.per_point(totals.parts.field_bits));
}

nlohmann::json latency_json(const std::vector<double>& latency_ms) {
  if (latency_ms.empty()) return nullptr;
  return {{"p50", quantile(latency_ms, 0.5)},
          {"p99", quantile(latency_ms, 0.99)},
          {"max", quantile(latency_ms, 1)},
          {"sweeps", latency_ms.size()}};
}

void print_latency(std::FILE* out, const std::vector<double>& latency_ms) {
  if (latency_ms.empty()) return;
  fmt::print(
      out,
      "  latency         p50 {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms from arrival to packet ({} sweeps)\n",
      quantile(latency_ms, 0.5), quantile(latency_ms, 0.99), quantile(latency_ms, 1), latency_ms.size());
}

void print_json(const EncodeTotals& totals, const StreamHeader& header, const FieldSelection& fields) {
  const bool in_space = header.on_sensor_grid();
  const Rates rates(totals);
  nlohmann::json bits_by_part;
  double container_bits = rates.bits();
  for (const auto& [name, bits] : parts_of(totals.parts, header)) {
    bits_by_part[std::string(name)] = bits;
    container_bits -= bits;
  }
  bits_by_part["container"] = container_bits;
  nlohmann::json json = {
      {"method", header.method == Method::mixture ? "mixture" : "planes"},
      {"frames", totals.frames},
      {"points", totals.points},
      {"points_kept", totals.points_out},
      {"points_lost", points_lost(totals)},
      {"points_non_finite", totals.non_finite},
      {"bytes", totals.bytes},
      {"bits_per_point", rates.geometry()},
      {"ratio_xyz32", rates.ratio_xyz32()},
      {"ms_per_frame",
       {{"median", quantile(totals.ms_per_frame, 0.5)}, {"p95", quantile(totals.ms_per_frame, 0.95)}}},
      {"sweeps_per_second_with_io",
       totals.wall_s > 0 ? static_cast<double>(totals.frames) / totals.wall_s : 0},
      {"bits_by_part", bits_by_part},
      {"bound_m", header.bound_m()},
      {"bound_kind", in_space ? "space" : "range"},
      {"fields_left_out", fields_left_out(totals, header, fields)}};
  if (totals.live) json["latency_ms"] = latency_json(totals.latency_ms);
  if (in_space) json.update(sensor_grid_json(totals, header, fields, rates));
  if (header.method == Method::planes) json.update(cells_json(totals));
  fmt::print("{}\n", json.dump(2));
}

void print_summary(const EncodeTotals& totals, const StreamHeader& header, const FieldSelection& fields,
                   const std::string& output) {
  std::FILE* out = output == "-" ? stderr : stdout;
  const Rates rates(totals);
  fmt::print(out,
             "{}: {} sweeps, {} points -> {} ({:.3f} bits per point{}, {:.1f} : 1 against 96-bit x, y, z)\n",
             output, totals.frames, totals.points, format_bytes(static_cast<double>(totals.bytes)),
             rates.geometry(), totals.parts.field_bits > 0 ? " without fields" : "", rates.ratio_xyz32());
  if (header.on_sensor_grid())
    print_sensor_grid(out, totals, header, fields, rates);
  else
    print_uniform_grid(out, totals, header, rates);
  fmt::print(out,
             "  time            {:.1f} ms per sweep (median), {:.1f} sweeps/s with reading and writing\n",
             quantile(totals.ms_per_frame, 0.5), static_cast<double>(totals.frames) / totals.wall_s);
  if (totals.live) print_latency(out, totals.latency_ms);
  const auto left_out = fields_left_out(totals, header, fields);
  if (!left_out.empty()) {
    fmt::print(out, "  left out        {}{}\n", fmt::join(left_out, ", "),
               header.on_sensor_grid() ? "" : " (the uniform grid carries geometry only)");
  }
}

}  // namespace

void EncodeTotals::add(const Packet& packet) {
  ++frames;
  points += packet.points_in;
  points_out += packet.points_out;
  non_finite += packet.non_finite;
  scattered_sweeps += packet.statistics.scattered_bits > 0;
  pointreel::add(parts, packet.statistics);
}

void print_report(const EncodeTotals& totals, const StreamHeader& header, const FieldSelection& fields,
                  const std::string& output, bool as_json) {
  if (as_json)
    print_json(totals, header, fields);
  else
    print_summary(totals, header, fields, output);
}

}  // namespace pointreel
