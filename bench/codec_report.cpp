#include "codec_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/quality.h"

namespace pointreel {
namespace {

nlohmann::json to_json(const Distances& distances) {
  return {{"mean_m", distances.mean_m()},
          {"rms_m", distances.rms_m()},
          {"p95_m", distances.p95_m()},
          {"max_m", distances.max_m()}};
}

nlohmann::json to_json(const std::vector<double>& ms) {
  return {{"median", quantile(ms, 0.5)}, {"p95", quantile(ms, 0.95)}};
}

// JSON has no infinity: null where nothing differs.
nlohmann::json psnr_json(const CloudDifference& difference) {
  nlohmann::json json = nlohmann::json::array();
  const auto finite = [](double db) { return std::isfinite(db) ? nlohmann::json(db) : nlohmann::json(); };
  for (const double peak_m : kPeaks_m) {
    json.push_back({{"peak_m", peak_m},
                    {"d1_db", finite(difference.d1_psnr_db(peak_m))},
                    {"d2_db", finite(difference.d2_psnr_db(peak_m))}});
  }
  return json;
}

std::string kept(const CodecMeasurement& m) {
  return fmt::format("{}{}{}", m.order_kept ? 'o' : '-', m.count_kept ? 'c' : '-',
                     m.fields_possible ? 'f' : '-');
}

}  // namespace

std::string to_json_line(const CodecMeasurement& m, const BenchSettings& settings) {
  const double bpp = m.bits_per_point();
  nlohmann::json json = {{"codec", m.family},
                         {"series", m.series},
                         {"settings", m.settings},
                         {"threads", m.threads},
                         {"rounds", settings.repeats},
                         {"sweeps", m.sweeps},
                         {"points_in", m.points_in},
                         {"points_out", m.points_out},
                         {"bytes", m.bytes},
                         {"bytes_of_sweep", m.bytes_of_sweep},
                         {"bits_per_point", bpp},
                         {"ratio_xyz32", bpp > 0 ? 96 / bpp : 0},    // against 96 bits a point
                         {"ratio_xyzi32", bpp > 0 ? 128 / bpp : 0},  // against 128, intensity counted
                         {"keeps_order", m.order_kept},
                         {"keeps_count", m.count_kept},
                         {"carries_fields", m.fields_possible},
                         {"encode_ms", to_json(m.encode_ms)},
                         {"decode_ms", to_json(m.decode_ms)},
                         {"peak_memory_mib", m.peak_mib},
                         {"failures", m.failures}};
  if (!m.difference.own.each_m.empty()) json["own_error"] = to_json(m.difference.own);
  if (!m.difference.to_decoded.each_m.empty()) {
    json["nearest_decoded"] = to_json(m.difference.to_decoded);
    json["nearest_original"] = to_json(m.difference.to_original);
    json["psnr"] = psnr_json(m.difference);
  }
  return json.dump();
}

void print_codec_table(const std::vector<CodecMeasurement>& measurements, const BenchSettings& settings) {
  fmt::print(
      "{:<32} {:<34} {:>6} {:>6} {:>6} {:>6} {:>4} | {:>7} {:>6} {:>6} {:>6} {:>7} | {:>6} {:>6} | "
      "{:>7} {:>7} {:>5}\n",
      "codec", "settings", "bpp", "96/bpp", "128/..", "points", "kept", "own max", "mean", "rms", "p95",
      "max", "D1", "D2", "enc ms", "dec ms", "MiB");
  std::string last_series;
  for (const CodecMeasurement& m : measurements) {
    const CloudDifference& d = m.difference;
    const double bpp = m.bits_per_point();
    fmt::print("{:<32} {:<34} ", m.series == last_series ? "" : m.series, m.settings);
    last_series = m.series;
    if (!m.failures.empty()) {
      fmt::print("FAILED: {}\n", m.failures.front());
      continue;
    }
    const auto worse = [](double a, double b) { return 100 * std::max(a, b); };
    fmt::print(
        "{:>6.3f} {:>6.1f} {:>6.1f} {:>5.1f}% {:>4} | {:>7} {:>6.2f} {:>6.2f} {:>6.2f} {:>7.2f} | "
        "{:>6.1f} {:>6.1f} | {:>7.1f} {:>7.1f} {:>5.0f}\n",
        bpp, 96 / bpp, 128 / bpp,
        100.0 * static_cast<double>(m.points_out) / static_cast<double>(m.points_in), kept(m),
        d.own.each_m.empty() ? "-" : fmt::format("{:.2f}", 100 * d.own.max_m()),
        worse(d.to_decoded.mean_m(), d.to_original.mean_m()), 100 * d.worse_rms_m(),
        worse(d.to_decoded.p95_m(), d.to_original.p95_m()), 100 * d.largest_nearest_m(),
        d.d1_psnr_db(kPeaks_m[0]), d.d2_psnr_db(kPeaks_m[0]), quantile(m.encode_ms, 0.5),
        quantile(m.decode_ms, 0.5), m.peak_mib);
  }
  fmt::print(
      "\nbpp: bits per input point, geometry only; 96/bpp and 128/..: ratio against float32 x, y, z and x, "
      "y, z, "
      "intensity.\n"
      "kept: o(rder), c(ount), f(ields possible). Errors in cm: own max, each point to its own; the rest, "
      "the "
      "nearest point, the\nworse direction. D1, D2: PSNR in dB with a peak of {:.2f} m (add {:.2f} dB for "
      "{:.0f} "
      "m). ms: median a sweep, {} round(s), {} thread(s)\nfor codecs that can use more than one. MiB: peak "
      "of a pass "
      "over the drive, decoded sweeps included.\n",
      kPeaks_m[0], 20 * std::log10(kPeaks_m[1] / kPeaks_m[0]), kPeaks_m[1], settings.repeats,
      settings.threads);
}

}  // namespace pointreel
