#include "pointreel/verify_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace pointreel {
namespace {

// The threshold is tested on float32 ranges; decoded points are float32, and moved, so allow for their
// rounding, which grows with the range.
constexpr double kRoundingAllowance_m = 1e-4;
constexpr double kRelativeRoundingAllowance = 3e-7;
// The bound in space is on the decoded float32 positions themselves; this is the rounding of measuring it.
constexpr double kMeasuringAllowance = 1e-12;

nlohmann::json to_json(const ErrorSummary& errors) {
  return {{"count", errors.count},
          {"mean_m", errors.mean_m()},
          {"rms_m", errors.rms_m()},
          {"max_m", errors.max_m}};
}

nlohmann::json to_json(const std::vector<double>& ms) {
  return {{"median", quantile(ms, 0.5)}, {"p95", quantile(ms, 0.95)}};
}

nlohmann::json to_json(const FieldDifferences& fields) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, difference] : fields) {
    json[name] = {{"max_difference", difference.max}, {"exact", difference.exact}};
  }
  return json;
}

double bits_per_point(const Verification& verification, std::uint64_t bytes) {
  const auto points = static_cast<double>(verification.quality.points_in);
  return points == 0 ? 0 : 8.0 * static_cast<double>(bytes) / points;
}

double geometry_bits_per_point(const Verification& verification) {
  return bits_per_point(verification, verification.bytes - verification.field_bytes);
}

void print_errors(const char* name, const ErrorSummary& errors) {
  fmt::print("  {:<34} {:>10} {:>9.4f} {:>9.4f} {:>9.4f}\n", name, errors.count, errors.mean_m(),
             errors.rms_m(), errors.max_m);
}

void print_error_heading() {
  fmt::print("  {:<34} {:>10} {:>9} {:>9} {:>9}\n", "error in metres", "points", "mean", "rms", "max");
}

void print_uniform_grid(const SweepQuality& quality) {
  fmt::print(
      "  points  {} in, {} out, {} lost to nearer ones in the same cell, {} not finite; order not kept\n\n",
      quality.points_in, quality.points_out, quality.points_lost, quality.non_finite);
  print_error_heading();
  print_errors("kept points, each to its own", quality.paired);
  print_errors("  along the ray", quality.paired_range);
  print_errors("  rounding to the cell's angles", quality.paired_angular);
  print_errors("all points to the nearest decoded", quality.nearest_decoded);
  print_errors("decoded to the nearest original", quality.nearest_original);
}

void print_sensor_grid(const Verification& verification) {
  const SweepQuality& quality = verification.quality;
  const std::string order = verification.frames_reordered == 0
                                ? "order kept"
                                : fmt::format("order not kept in {} sweeps", verification.frames_reordered);
  fmt::print("  points  {} in, {} out, {} lost, {} not finite; {}\n\n", quality.points_in, quality.points_out,
             quality.points_lost, quality.non_finite, order);
  print_error_heading();
  print_errors("every point to its own", quality.paired);
  print_errors("  along the ray", quality.paired_range);
  print_errors("  across it", quality.paired_angular);
  fmt::print("\n");
  for (const auto& [name, difference] : verification.fields) {
    fmt::print("  field {}: {}\n", name,
               difference.exact ? "exact" : fmt::format("off by {:g} at most", difference.max));
  }
  if (verification.frames_reordered > 0 && verification.field_bytes > 0) {
    fmt::print("  fields of sweeps whose order is not kept cannot be compared\n");
  }
}

}  // namespace

std::optional<bool> bound_held(const Verification& verification, const StreamHeader& header) {
  if (verification.frames == 0) return std::nullopt;
  const SweepQuality& quality = verification.quality;
  if (header.on_sensor_grid()) {
    return quality.points_lost == 0 && quality.paired.max_m <= header.bound_m() * (1 + kMeasuringAllowance);
  }
  const double rounding_m = kRoundingAllowance_m + kRelativeRoundingAllowance * quality.farthest_m;
  return quality.paired_range.max_m <= header.bound_m() + rounding_m;
}

void print_json(const Verification& verification, const StreamHeader& header) {
  const SweepQuality& quality = verification.quality;
  const double bpp = geometry_bits_per_point(verification);
  const auto held = bound_held(verification, header);
  nlohmann::json json = {{"method", header.method == Method::mixture ? "mixture" : "planes"},
                         {"frames", verification.frames},
                         {"frames_missing", verification.frames_missing},
                         {"points_in", quality.points_in},
                         {"points_out", quality.points_out},
                         {"points_lost", quality.points_lost},
                         {"points_non_finite", quality.non_finite},
                         {"max_error_m", quality.paired.max_m},
                         {"mean_error_m", quality.paired.mean_m()},
                         {"rmse_m", quality.paired.rms_m()},
                         {"range_error", to_json(quality.paired_range)},
                         {"bound_m", header.bound_m()},
                         {"bound_held", held ? nlohmann::json(*held) : nlohmann::json()},
                         {"order_preserved", verification.frames_reordered == 0},
                         {"bits_per_point", bpp},
                         {"ratio_xyz32", bpp > 0 ? 96 / bpp : 0},
                         {"encode_ms", to_json(verification.encode_ms)},
                         {"decode_ms", to_json(verification.decode_ms)}};
  if (header.on_sensor_grid()) {
    json.update({{"pairing", "every finite point with its own decoded point"},
                 {"bound_kind", "space"},
                 {"temporal", verification.temporal},
                 {"cross_error", to_json(quality.paired_angular)},
                 {"bits_per_point_with_fields", bits_per_point(verification, verification.bytes)},
                 {"frames_reordered", verification.frames_reordered},
                 {"fields", to_json(verification.fields)}});
  } else {
    json.update({{"pairing", "kept points with their own decoded point; nearest both ways for all points"},
                 {"bound_kind", "range"},
                 {"angular_rounding", to_json(quality.paired_angular)},
                 {"nearest_decoded", to_json(quality.nearest_decoded)},
                 {"nearest_original", to_json(quality.nearest_original)}});
  }
  fmt::print("{}\n", json.dump(2));
}

void print_table(const Verification& verification, const StreamHeader& header, const std::string& reel) {
  const auto held = bound_held(verification, header);
  if (!held) {
    fmt::print("{}: no whole sweep in it, nothing was verified\n", reel);
    return;
  }
  const double bpp = geometry_bits_per_point(verification);
  fmt::print("{}: {} sweeps, {:.3f} bits per point ({:.1f} : 1 against 96-bit x, y, z)", reel,
             verification.frames, bpp, bpp > 0 ? 96 / bpp : 0);
  if (verification.field_bytes > 0)
    fmt::print(", {:.3f} with fields", bits_per_point(verification, verification.bytes));
  fmt::print("\n");
  if (header.on_sensor_grid())
    print_sensor_grid(verification);
  else
    print_uniform_grid(verification.quality);
  fmt::print("\n  encode {:.1f} ms, decode {:.1f} ms per sweep (medians)\n",
             quantile(verification.encode_ms, 0.5), quantile(verification.decode_ms, 0.5));
  fmt::print("  {} bound {:g} m for {}: {}\n", header.on_sensor_grid() ? "error" : "range", header.bound_m(),
             header.on_sensor_grid() ? "every point" : "kept points", *held ? "held" : "BROKEN");
}

}  // namespace pointreel
