// MPEG's G-PCC through its reference program `tmc3`, where that is on PATH: octree, and predictive geometry
// in angular mode with the laser table of our own sensor model. Coordinates are whole millimetres, and tenths
// of them for the octree.
#include <cmath>
#include <ranges>

#include "codecs/bounds.h"
#include "codecs/program_codec.h"
#include "pointreel/io.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

constexpr std::uint32_t kTicksPerTurn = 4000;  // of a sensor whose own are not known

// tmc3's rows go from the lowest laser to the highest, heights below the origin in the coordinates' units.
std::vector<std::string> laser_table(const SensorModel& model, int azimuth_log2, double units_per_m) {
  const std::uint32_t ticks_per_turn = model.ticks_per_turn > 0 ? model.ticks_per_turn : kTicksPerTurn;
  std::string slopes, heights, ticks;
  for (const RowModel& row : model.rows | std::views::reverse) {
    const char* comma = slopes.empty() ? "" : ", ";
    slopes += fmt::format("{}{:.6f}", comma, row.slope);
    heights += fmt::format("{}{:.3f}", comma, -units_per_m * row.offset_m);
    ticks += fmt::format("{}{}", comma, ticks_per_turn);
  }
  return {"--angularEnabled=1",
          fmt::format("--numLasers={}", model.row_count()),
          "--lasersTheta=" + slopes,
          "--lasersZ=" + heights,
          "--lasersNumPhiPerTurn=" + ticks,
          fmt::format("--positionAzimuthScaleLog2={}", azimuth_log2),
          fmt::format("--positionAzimuthSpeed={:.0f}", std::ldexp(1.0, azimuth_log2 + 12) / ticks_per_turn)};
}

struct Tmc3Settings {
  std::string series, text;
  double units_per_m;               // coordinates are whole units
  std::optional<int> azimuth_log2;  // positionAzimuthScaleLog2; none: not in angular mode
  std::vector<std::string> arguments;
};

class Tmc3Encoder final : public ProgramEncoder {
 public:
  Tmc3Encoder(std::filesystem::path program, const Tmc3Settings& settings)
      : ProgramEncoder(std::move(program)), settings_(settings) {}

 private:
  Result<Bytes> encode_sweep(const PointCloud& sweep, ProgramRunner& runner) override {
    if (settings_.azimuth_log2 && lasers_.empty()) {
      SensorEstimator estimator;
      estimator.add(sweep);
      if (!estimator.model()) return Error{ErrorCode::unsupported, "no lasers found in the first sweep"};
      lasers_ = laser_table(*estimator.model(), *settings_.azimuth_log2, settings_.units_per_m);
    }
    if (auto written = write_cloud(runner.file("in.ply"), in_whole_units(sweep), CloudFormat::ply); !written)
      return written.error();
    std::vector<std::string> arguments = {"--mode=0", "--disableAttributeCoding=1",
                                          "--uncompressedDataPath=" + runner.file("in.ply"),
                                          "--compressedStreamPath=" + runner.file("out.bin")};
    arguments.insert(arguments.end(), lasers_.begin(), lasers_.end());
    arguments.insert(arguments.end(), settings_.arguments.begin(), settings_.arguments.end());
    if (auto ran = runner.run(arguments); !ran) return ran.error();
    return read_bytes(runner.file("out.bin"));
  }

  // tmc3 would cut off what is behind the point, and the millimetres that float32 metres stand for with it.
  PointCloud in_whole_units(const PointCloud& sweep) const {
    const auto whole = [this](float m) { return static_cast<float>(std::round(settings_.units_per_m * m)); };
    PointCloud cloud;
    cloud.positions.reserve(sweep.size());
    for (const Point3f& p : sweep.positions) cloud.positions.push_back({whole(p.x), whole(p.y), whole(p.z)});
    return cloud;
  }

  const Tmc3Settings& settings_;
  std::vector<std::string> lasers_;
};

class Tmc3Decoder final : public ProgramDecoder {
 public:
  Tmc3Decoder(std::filesystem::path program, double units_per_m)
      : ProgramDecoder(std::move(program)), units_per_m_(static_cast<float>(units_per_m)) {}

 private:
  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes, ProgramRunner& runner) override {
    if (auto written = write_bytes(runner.file("in.bin"), bytes); !written) return written.error();
    auto ran = runner.run({"--mode=1", "--compressedStreamPath=" + runner.file("in.bin"),
                           "--reconstructedDataPath=" + runner.file("out.ply")});
    if (!ran) return ran.error();
    auto sweep = read_cloud(runner.file("out.ply"));
    if (!sweep) return sweep.error();
    for (Point3f& p : sweep->positions) p = {p.x / units_per_m_, p.y / units_per_m_, p.z / units_per_m_};
    return sweep;
  }

  float units_per_m_;
};

class Tmc3 final : public Codec {
 public:
  Tmc3(std::filesystem::path program, Tmc3Settings settings)
      : program_(std::move(program)), settings_(std::move(settings)) {}

  std::string series() const override { return settings_.series; }
  std::string settings() const override { return settings_.text; }
  bool carries_fields() const override { return true; }
  std::unique_ptr<SweepEncoder> encoder(const DriveContext&) const override {
    return std::make_unique<Tmc3Encoder>(program_, settings_);
  }
  std::unique_ptr<SweepDecoder> decoder(const DriveContext&) const override {
    return std::make_unique<Tmc3Decoder>(program_, settings_.units_per_m);
  }

 private:
  std::filesystem::path program_;
  Tmc3Settings settings_;
};

// The corner of a cube is sqrt(3) / 2 of its side away from the centre.
Tmc3Settings octree(double max_error_m) {
  constexpr double kUnitsPer_m = 10'000;
  const double cell_m = max_error_m * 2 / std::sqrt(3.0) - 2 / kUnitsPer_m;  // coordinates are rounded twice
  return {"G-PCC octree",
          "cells of " + in_centimetres(std::round(cell_m * 1e4) / 1e4),
          kUnitsPer_m,
          {},
          {"--mergeDuplicatedPoints=1", "--neighbourAvailBoundaryLog2=8", "--intra_pred_max_node_size_log2=6",
           "--planarEnabled=1", "--inferredDirectCodingMode=1",
           fmt::format("--positionQuantizationScale={:.9f}", 1 / (kUnitsPer_m * cell_m))}};
}

constexpr int kAzimuthLog2OfMillimetres = 13;
const std::vector<std::string> kPredictive = {"--geomTreeType=1", "--predGeomSort=0",
                                              "--mergeDuplicatedPoints=0"};

// Ranges in steps of 2^radius_log2 mm along the lasers' rays: the fewest bits where points lie on them.
Tmc3Settings predictive(int radius_log2) {
  Tmc3Settings settings{"G-PCC predictive", fmt::format("steps of {} mm", 1 << radius_log2), 1000,
                        kAzimuthLog2OfMillimetres - radius_log2, kPredictive};
  settings.arguments.emplace_back("--secondaryResidualDisabled=1");
  settings.arguments.push_back(fmt::format("--positionRadiusInvScaleLog2={}", radius_log2));
  return settings;
}

// Points on a lattice, kept exactly: what the rays leave is corrected in x, y and z. The corner of a cube is
// sqrt(3) / 2 of its side away from the centre.
Tmc3Settings predictive_corrected(const std::string& text, double lattice_m) {
  const auto coarser_log2 = static_cast<int>(std::lround(std::log2(1000 * lattice_m)));
  return {"G-PCC predictive, corrected", text, 1 / lattice_m, kAzimuthLog2OfMillimetres - coarser_log2,
          kPredictive};
}

Result<Codecs> tmc3_settings() {
  const auto program = find_program("tmc3");
  if (!program) return Error{ErrorCode::unsupported, "no program tmc3 on PATH"};
  Codecs codecs;
  for (const double bound_m : kBounds_m) codecs.push_back(std::make_unique<Tmc3>(*program, octree(bound_m)));
  for (const int radius_log2 : {3, 4, 5, 6, 7, 8, 9})
    codecs.push_back(std::make_unique<Tmc3>(*program, predictive(radius_log2)));
  codecs.push_back(std::make_unique<Tmc3>(*program, predictive_corrected("every mm", 0.001)));
  for (const double bound_m : kBounds_m) {
    codecs.push_back(std::make_unique<Tmc3>(
        *program,
        predictive_corrected("max error " + in_centimetres(bound_m), (bound_m - 3e-5) * 2 / std::sqrt(3.0))));
  }
  return codecs;
}

const CodecRegistration tmc3_registration("gpcc", tmc3_settings);

}  // namespace
}  // namespace pointreel
