// MPEG's G-PCC through its reference program `tmc3`, where that is on PATH: octree, and predictive geometry
// in angular mode with the laser table of our own sensor model. A process a sweep each way; coordinates in
// whole millimetres.
#include <cmath>
#include <ranges>

#include "codecs/bounds.h"
#include "codecs/program.h"
#include "pointreel/io.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

constexpr std::uint32_t kTicksPerTurn = 4000;  // of a sensor whose own are not known

// tmc3's rows go from the lowest laser to the highest, heights in millimetres below the origin.
std::vector<std::string> laser_table(const SensorModel& model, int azimuth_log2) {
  const std::uint32_t ticks_per_turn = model.ticks_per_turn > 0 ? model.ticks_per_turn : kTicksPerTurn;
  std::string slopes, heights, ticks;
  for (const RowModel& row : model.rows | std::views::reverse) {
    const char* comma = slopes.empty() ? "" : ", ";
    slopes += fmt::format("{}{:.6f}", comma, row.slope);
    heights += fmt::format("{}{:.3f}", comma, -1000 * row.offset_m);
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
  std::optional<int> azimuth_log2;  // positionAzimuthScaleLog2; none: not in angular mode
  std::vector<std::string> arguments;
};

class Tmc3Encoder final : public SweepEncoder {
 public:
  Tmc3Encoder(std::filesystem::path program, const Tmc3Settings& settings)
      : program_(std::move(program)), settings_(settings) {}

  Result<std::vector<Chunk>> encode(const PointCloud& sweep) override {
    if (settings_.azimuth_log2 && lasers_.empty()) {
      SensorEstimator estimator;
      estimator.add(sweep);
      if (!estimator.model()) return Error{ErrorCode::unsupported, "no lasers found in the first sweep"};
      lasers_ = laser_table(*estimator.model(), *settings_.azimuth_log2);
    }
    const PointCloud positions{sweep.positions, {}};
    if (auto written = write_cloud(folder_ / "in.ply", positions, CloudFormat::ply); !written)
      return written.error();
    std::vector<std::string> arguments = {"--mode=0", "--inputScale=1000", "--disableAttributeCoding=1",
                                          "--uncompressedDataPath=" + (folder_ / "in.ply"),
                                          "--compressedStreamPath=" + (folder_ / "out.bin")};
    arguments.insert(arguments.end(), lasers_.begin(), lasers_.end());
    arguments.insert(arguments.end(), settings_.arguments.begin(), settings_.arguments.end());
    const auto kib = run_program(program_, arguments);
    if (!kib) return kib.error();
    peak_kib_ = std::max(peak_kib_, *kib);
    auto bytes = read_bytes(folder_ / "out.bin");
    if (!bytes) return bytes.error();
    return std::vector<Chunk>{{*std::move(bytes), 1}};
  }
  std::size_t program_peak_kib() const override { return peak_kib_; }

 private:
  std::filesystem::path program_;
  const Tmc3Settings& settings_;
  std::size_t peak_kib_ = 0;
  std::vector<std::string> lasers_;
  ScratchFolder folder_;
};

class Tmc3Decoder final : public SweepDecoder {
 public:
  explicit Tmc3Decoder(std::filesystem::path program) : program_(std::move(program)) {}

  Result<std::vector<PointCloud>> decode(const Chunk& chunk) override {
    if (auto written = write_bytes(folder_ / "in.bin", chunk.bytes); !written) return written.error();
    const auto kib = run_program(program_, {"--mode=1", "--compressedStreamPath=" + (folder_ / "in.bin"),
                                            "--reconstructedDataPath=" + (folder_ / "out.ply")});
    if (!kib) return kib.error();
    peak_kib_ = std::max(peak_kib_, *kib);
    auto sweep = read_cloud(folder_ / "out.ply");
    if (!sweep) return sweep.error();
    for (Point3f& p : sweep->positions) p = {p.x / 1000, p.y / 1000, p.z / 1000};
    return std::vector<PointCloud>{*std::move(sweep)};
  }
  std::size_t program_peak_kib() const override { return peak_kib_; }

 private:
  std::filesystem::path program_;
  std::size_t peak_kib_ = 0;
  ScratchFolder folder_;
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
    return std::make_unique<Tmc3Decoder>(program_);
  }

 private:
  std::filesystem::path program_;
  Tmc3Settings settings_;
};

// The corner of a cube is sqrt(3) / 2 of its side away from the centre; whole millimetres may add one.
Tmc3Settings octree(double max_error_m) {
  const double cell_m = (max_error_m - 0.001) * 2 / std::sqrt(3.0);
  return {"G-PCC octree",
          "cells of " + in_centimetres(std::round(cell_m * 1e4) / 1e4),
          {},
          {"--mergeDuplicatedPoints=1", "--neighbourAvailBoundaryLog2=8", "--intra_pred_max_node_size_log2=6",
           "--planarEnabled=1", "--inferredDirectCodingMode=1",
           fmt::format("--positionQuantizationScale={:.9f}", 0.001 / cell_m)}};
}

// `radius_log2`: ranges in steps of 2^radius_log2 mm; 0: every millimetre exactly.
Tmc3Settings predictive(int radius_log2) {
  Tmc3Settings settings{"G-PCC predictive",
                        radius_log2 == 0 ? "every mm" : fmt::format("steps of {} mm", 1 << radius_log2),
                        13 - radius_log2,
                        {"--geomTreeType=1", "--predGeomSort=0", "--mergeDuplicatedPoints=0"}};
  if (radius_log2 > 0) {
    settings.arguments.emplace_back("--secondaryResidualDisabled=1");
    settings.arguments.push_back(fmt::format("--positionRadiusInvScaleLog2={}", radius_log2));
  }
  return settings;
}

Result<Codecs> settings() {
  const auto program = find_program("tmc3");
  if (!program) return Error{ErrorCode::unsupported, "no program tmc3 on PATH"};
  Codecs codecs;
  for (const double bound_m : kBounds_m) codecs.push_back(std::make_unique<Tmc3>(*program, octree(bound_m)));
  for (const int radius_log2 : {0, 3, 4, 5, 6, 7, 8})
    codecs.push_back(std::make_unique<Tmc3>(*program, predictive(radius_log2)));
  return codecs;
}

const CodecRegistration registration("gpcc", settings);

}  // namespace
}  // namespace pointreel
