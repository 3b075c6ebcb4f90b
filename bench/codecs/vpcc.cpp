// MPEG's V-PCC through its reference programs, where they are on PATH: patches of points, projected to the
// sides of a box, as H.265 video. Every sweep by itself; voxels are kept exactly, since its lossy rates lose
// points that are metres away from any other.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include "codecs/bounds.h"
#include "codecs/program_codec.h"
#include "pointreel/io.h"

namespace pointreel {
namespace {

struct VpccPrograms {
  std::filesystem::path encoder, decoder;
  std::filesystem::path configuration;  // its folder cfg
};

// The common test conditions for geometry kept exactly, whose own file its release 24 does not read, and a QP
// that its 8-bit video allows.
const std::vector<std::string> kExactGeometry = {"--noAttributes=1",
                                                 "--geometryQP=0",
                                                 "--occupancyPrecision=1",
                                                 "--enhancedOccupancyMapCode=1",
                                                 "--rawPointsPatch=1",
                                                 "--lossyRawPointsPatch=0",
                                                 "--useRawPointsSeparateVideo=0",
                                                 "--maxAllowedDist2RawPointsSelection=0",
                                                 "--attributeVideo444=1",
                                                 "--attributeBGFill=3",
                                                 "--pbfEnableFlag=0",
                                                 "--flagGeometrySmoothing=0",
                                                 "--gridSmoothing=0",
                                                 "--flagColorPreSmoothing=0",
                                                 "--pointLocalReconstruction=0",
                                                 "--singleMapPixelInterleaving=0"};

// Coordinates are whole steps from the least ones of the sweep, which go before the stream: V-PCC's have no
// sign.
class VpccEncoder final : public ProgramEncoder {
 public:
  VpccEncoder(const VpccPrograms& programs, double step_m)
      : ProgramEncoder(programs.encoder), configuration_(programs.configuration), step_m_(step_m) {}

 private:
  Result<Bytes> encode_sweep(const PointCloud& sweep, ProgramRunner& runner) override {
    if (sweep.positions.empty()) return Error{ErrorCode::unsupported, "V-PCC takes no empty sweeps"};
    Point3f origin_m = sweep.positions.front();
    for (const Point3f& p : sweep.positions)
      origin_m = {std::min(origin_m.x, p.x), std::min(origin_m.y, p.y), std::min(origin_m.z, p.z)};
    const PointCloud voxels = voxels_of(sweep, origin_m);
    if (auto written = write_cloud(runner.file("in.ply"), voxels, CloudFormat::ply); !written)
      return written.error();
    float largest = 0;
    for (const Point3f& p : voxels.positions) largest = std::max({largest, p.x, p.y, p.z});
    const int bits = std::max(8, static_cast<int>(std::ceil(std::log2(largest + 1))));
    std::vector<std::string> arguments = {
        "--configurationFolder=" + (configuration_ / "").string(),
        "--config=" + (configuration_ / "common/ctc-common.cfg").string(),
        "--config=" + (configuration_ / "condition/ctc-all-intra-lossless-geometry.cfg").string(),
        "--uncompressedDataPath=" + runner.file("in.ply"),
        "--compressedStreamPath=" + runner.file("out.bin"),
        "--startFrameNumber=0",
        "--frameCount=1",
        "--groupOfFramesSize=1",
        fmt::format("--geometry3dCoordinatesBitdepth={}", bits),
        "--nbThread=1",
        "--computeMetrics=0",
        "--computeChecksum=0"};
    arguments.insert(arguments.end(), kExactGeometry.begin(), kExactGeometry.end());
    if (auto ran = runner.run(arguments); !ran) return ran.error();
    const auto stream = read_bytes(runner.file("out.bin"));
    if (!stream) return stream.error();
    Bytes bytes(sizeof(origin_m));
    std::memcpy(bytes.data(), &origin_m, sizeof(origin_m));
    bytes.insert(bytes.end(), stream->begin(), stream->end());
    return bytes;
  }

  // V-PCC ends where two points are the same, or have no colour.
  PointCloud voxels_of(const PointCloud& sweep, const Point3f& origin_m) const {
    const auto steps = [this](float m, float least_m) {
      return static_cast<float>(std::round((double{m} - double{least_m}) / step_m_));
    };
    std::set<std::array<float, 3>> voxels;
    for (const Point3f& p : sweep.positions)
      voxels.insert({steps(p.x, origin_m.x), steps(p.y, origin_m.y), steps(p.z, origin_m.z)});
    PointCloud cloud;
    for (const auto& [x, y, z] : voxels) cloud.positions.push_back({x, y, z});
    for (const char* colour : {"red", "green", "blue"})
      cloud.fields.push_back({colour, std::vector<std::uint8_t>(cloud.size(), 128)});
    return cloud;
  }

  std::filesystem::path configuration_;
  double step_m_;
};

class VpccDecoder final : public ProgramDecoder {
 public:
  VpccDecoder(VpccPrograms programs, double step_m)
      : ProgramDecoder(programs.decoder),
        configuration_(std::move(programs.configuration)),
        step_m_(step_m) {}

 private:
  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes, ProgramRunner& runner) override {
    Point3f origin_m;
    if (bytes.size() < sizeof(origin_m)) return Error{ErrorCode::corrupt, "no origin before V-PCC's stream"};
    std::memcpy(&origin_m, bytes.data(), sizeof(origin_m));
    if (auto written = write_bytes(runner.file("in.bin"), bytes.subspan(sizeof(origin_m))); !written)
      return written.error();
    // The conversion of colours is asked for where there are none, too.
    auto ran = runner.run({"--compressedStreamPath=" + runner.file("in.bin"),
                           "--reconstructedDataPath=" + runner.file("out.ply"), "--startFrameNumber=0",
                           "--nbThread=1",
                           "--inverseColorSpaceConversionConfig=" +
                               (configuration_ / "hdrconvert/yuv420toyuv444_16bit.cfg").string(),
                           "--computeMetrics=0", "--computeChecksum=0"});
    if (!ran) return ran.error();
    auto sweep = read_cloud(runner.file("out.ply"));
    if (!sweep) return sweep.error();
    const auto metres = [this](float steps, float least_m) {
      return static_cast<float>(double{least_m} + step_m_ * double{steps});
    };
    for (Point3f& p : sweep->positions)
      p = {metres(p.x, origin_m.x), metres(p.y, origin_m.y), metres(p.z, origin_m.z)};
    return sweep;
  }

  std::filesystem::path configuration_;
  double step_m_;
};

class Vpcc final : public Codec {
 public:
  Vpcc(VpccPrograms programs, double step_m) : programs_(std::move(programs)), step_m_(step_m) {}

  std::string series() const override { return "V-PCC"; }
  std::string settings() const override {
    return "voxels of " + in_centimetres(std::round(step_m_ * 1e4) / 1e4);
  }
  bool carries_fields() const override { return true; }
  std::unique_ptr<SweepEncoder> encoder(const DriveContext&) const override {
    return std::make_unique<VpccEncoder>(programs_, step_m_);
  }
  std::unique_ptr<SweepDecoder> decoder(const DriveContext&) const override {
    return std::make_unique<VpccDecoder>(programs_, step_m_);
  }

 private:
  VpccPrograms programs_;
  double step_m_;
};

Result<Codecs> vpcc_settings() {
  const auto encoder = find_program("PccAppEncoder"), decoder = find_program("PccAppDecoder");
  if (!encoder || !decoder)
    return Error{ErrorCode::unsupported, "no programs PccAppEncoder and PccAppDecoder on PATH"};
  std::error_code failed;
  // They are built into the folder bin of their sources, and cannot do without their settings.
  const auto configuration = std::filesystem::canonical(*encoder, failed).parent_path().parent_path() / "cfg";
  if (!std::filesystem::is_directory(configuration, failed))
    return Error{ErrorCode::unsupported, configuration.string() + " of PccAppEncoder: not found"};
  Codecs codecs;
  // Half a minute a sweep each; finer ones take minutes. The corner of a voxel is sqrt(3) / 2 of its side
  // away from the centre.
  for (const double bound_m : {0.1, 0.2}) {
    codecs.push_back(std::make_unique<Vpcc>(VpccPrograms{*encoder, *decoder, configuration},
                                            (bound_m - 1e-4) * 2 / std::sqrt(3.0)));
  }
  return codecs;
}

const CodecRegistration vpcc_registration("vpcc", vpcc_settings);

}  // namespace
}  // namespace pointreel
