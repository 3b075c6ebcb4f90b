// Every codec that was built gives every sweep back, with the errors that its settings promise.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "cloud_difference.h"
#include "codec_measurement.h"
#include "pointreel/simulator.h"

namespace pointreel {
namespace {

SweepSet small_drive() {
  SimulatorOptions options;
  options.sensor = SensorKind::vlp_16;
  Simulator simulator(options);
  SweepSet set;
  for (int i = 0; i < 2; ++i) {
    SimulatedSweep sweep = simulator.next_sweep();
    set.poses.push_back(sweep.T_world_sensor);
    set.points += sweep.cloud.size();
    set.sweeps.push_back(std::move(sweep.cloud));
    set.sweeps.back().fields.clear();
  }
  return set;
}

// "max error 5 cm" and "levels for 5 cm, ..." promise that all points are there and so near.
std::optional<double> promised_m(const Codec& codec) {
  const std::string settings = codec.settings();
  if (codec.series().find("uniform") != std::string::npos) return {};
  for (const std::string start : {"max error ", "levels for "}) {
    if (settings.starts_with(start)) return std::atof(settings.c_str() + start.size()) / 100;
  }
  return {};
}

// Codecs that merge points promise that no point is farther from a decoded one than a cube's corner from its
// centre.
std::optional<double> nearest_promised_m(const Codec& codec) {
  if (const auto own_m = promised_m(codec)) return own_m;
  constexpr double kCorner = 0.866026;
  const std::string settings = codec.settings();
  if (settings == "every mm") return 0.001 * kCorner;
  for (const std::string start : {"cells of ", "voxels of "}) {
    if (settings.starts_with(start)) return std::atof(settings.c_str() + start.size()) / 100 * kCorner + 2e-4;
  }
  return {};
}

class EveryCodec : public testing::TestWithParam<std::string> {};

TEST_P(EveryCodec, GivesAllSweepsBack) {
  const SweepSet set = small_drive();
  std::map<std::string, std::string> skipped;
  const auto codecs = choose_codecs({GetParam()}, skipped);
  ASSERT_TRUE(codecs);
  if (codecs->empty()) GTEST_SKIP() << skipped[GetParam()];
  const ComparedSweep last(set.sweeps.back());
  std::set<std::string> names;
  for (const NamedCodec& named : *codecs) {
    const Codec& codec = *named.codec;
    SCOPED_TRACE(codec.series() + ", " + codec.settings());
    EXPECT_TRUE(names.insert(codec.series() + codec.settings()).second);
    const CodecPass pass = run_codec(codec, set.sweeps, {set.poses, 2});
    ASSERT_FALSE(pass.failure) << pass.failure->message;
    ASSERT_EQ(pass.decoded.size(), set.sweeps.size());
    EXPECT_EQ(pass.encode_ms.size(), set.sweeps.size());
    EXPECT_EQ(pass.decode_ms.size(), set.sweeps.size());
    for (const PointCloud& cloud : pass.decoded) ASSERT_FALSE(cloud.positions.empty());
    if (pass.order_kept) {
      for (std::size_t i = 0; i < set.sweeps.size(); ++i) {
        ASSERT_EQ(pass.decoded[i].size(), set.sweeps[i].size());
        EXPECT_LE(own_distances(set.sweeps[i].positions, pass.decoded[i].positions).max_m(),
                  promised_m(codec).value_or(0) + 1e-6);
      }
    }
    const CloudDifference difference = nearest_differences(last, pass.decoded.back().positions);
    if (promised_m(codec)) {
      EXPECT_EQ(pass.decoded.back().size(), set.sweeps.back().size());
    }
    if (const auto promised = nearest_promised_m(codec)) {
      EXPECT_LE(difference.largest_nearest_m(), *promised + 1e-5);
    } else {
      EXPECT_LT(difference.to_original.mean_m(),
                1.5);  // of the coarsest settings: no other sweep, no other place
    }
  }
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const CodecFamily& family : codec_families()) names.push_back(family.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Codecs, EveryCodec, testing::ValuesIn(family_names()), [](const auto& family) {
  std::string name = family.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ChooseCodecs, NamesTheUnknownOne) {
  std::map<std::string, std::string> skipped;
  const auto codecs = choose_codecs({"mixture", "zip"}, skipped);
  ASSERT_FALSE(codecs);
  EXPECT_NE(codecs.error().message.find("'zip' is none of"), std::string::npos);
}

TEST(MeasureCodecs, AddsUpBytesTimesAndErrors) {
  const SweepSet set = small_drive();
  std::map<std::string, std::string> skipped;
  auto codecs = choose_codecs({"mixture"}, skipped);
  ASSERT_TRUE(codecs);
  codecs->erase(codecs->begin() + 1, codecs->end());
  const auto measurements =
      measure_codecs(*codecs, set, {.repeats = 2, .nearest_sweeps = 1}, [](std::size_t) {});
  ASSERT_EQ(measurements.size(), 1U);
  const CodecMeasurement& m = measurements[0];
  EXPECT_TRUE(m.failures.empty());
  EXPECT_EQ(m.encode_ms.size(), 2 * set.sweeps.size());
  EXPECT_EQ(m.bytes_of_sweep.size(), set.sweeps.size());
  EXPECT_EQ(m.points_in, set.points);
  EXPECT_EQ(m.points_out, set.points);
  EXPECT_TRUE(m.order_kept && m.count_kept);
  EXPECT_EQ(m.difference.own.each_m.size(), set.points);
  EXPECT_EQ(m.difference.to_decoded.each_m.size(), set.sweeps[1].size());
  EXPECT_GT(m.bits_per_point(), 0.5);
  EXPECT_LT(m.bits_per_point(), 10);
}

// A codec that fails on the second sweep, or has nothing that can be decoded.
class FaultyCodec final : public SingleSweepCodec {
 public:
  explicit FaultyCodec(bool in_decoder) : in_decoder_(in_decoder) {}
  std::string series() const override { return "faulty"; }
  std::string settings() const override { return ""; }
  Result<Bytes> encode_sweep(const PointCloud&) const override {
    if (!in_decoder_ && ++calls_ == 2) return Error{ErrorCode::unsupported, "no second sweep"};
    return Bytes{1};
  }
  Result<PointCloud> decode_sweep(std::span<const std::uint8_t>) const override {
    return Error{ErrorCode::corrupt, "not to be decoded"};
  }

 private:
  bool in_decoder_;
  mutable int calls_ = 0;
};

TEST(MeasureCodecs, ReportsFailuresOfBothWays) {
  const SweepSet set = small_drive();
  std::vector<NamedCodec> codecs;
  codecs.push_back({"faulty", std::make_unique<FaultyCodec>(false)});
  codecs.push_back({"faulty", std::make_unique<FaultyCodec>(true)});
  const auto measurements = measure_codecs(codecs, set, {.nearest_sweeps = 1}, [](std::size_t) {});
  EXPECT_EQ(measurements[0].failures, std::vector<std::string>{"no second sweep"});
  EXPECT_EQ(measurements[1].failures, std::vector<std::string>{"not to be decoded"});
}

}  // namespace
}  // namespace pointreel
