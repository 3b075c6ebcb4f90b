// Method `mixture`: every point of any cloud within the bound.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numeric>
#include <random>

#include "support/clouds.h"
#include "support/mixture_round_trip.h"

namespace pointreel {
namespace {

const std::vector<double> kBounds_m = {0.0005, 0.02, 1};

TEST(Mixture, AwkwardCloudsOneByOne) {
  for (const double bound_m : kBounds_m) {
    for (const NamedCloud& named : awkward_clouds()) {
      SCOPED_TRACE(named.name + " at " + std::to_string(bound_m));
      check_mixture_round_trip({named.cloud}, mixture_options(bound_m));
    }
  }
}

TEST(Mixture, AwkwardCloudsBetweenSweepsOfASensor) {
  const auto drive = clouds_of(simulated_drive(2));
  std::vector<PointCloud> sweeps;
  for (NamedCloud& named : awkward_clouds()) {
    sweeps.push_back(drive[0]);
    sweeps.push_back(drive[1]);
    named.cloud.fields.clear();
    sweeps.push_back(std::move(named.cloud));
  }
  check_mixture_round_trip(sweeps, mixture_options(0.02));
}

TEST(Mixture, KeepsTheOrderOfASensor) {
  for (const SensorKind sensor : {SensorKind::vlp_16, SensorKind::hdl_64e}) {
    for (const double bound_m : kBounds_m) {
      const auto sweeps = clouds_of(simulated_drive(2, sensor));
      for (const DecodedSweep& sweep : check_mixture_round_trip(sweeps, mixture_options(bound_m))) {
        EXPECT_TRUE(sweep.order_kept);
      }
    }
  }
}

// The grid holds one return a cell; the rest are strays.
TEST(Mixture, SecondReturnsDuplicatesAndZerosOnAGrid) {
  PointCloud sweep = simulated_drive(1)[0].cloud;
  sweep.fields.clear();
  const std::size_t count = sweep.size();
  for (std::size_t i = 0; i < count; i += 9) {
    const Point3f p = sweep.positions[i];
    sweep.positions.push_back(i % 2 == 0 ? p : Point3f{1.3F * p.x, 1.3F * p.y, 1.3F * p.z});
  }
  for (std::size_t i = 4; i < count; i += 23) sweep.positions[i] = {};
  check_mixture_round_trip({sweep, sweep}, mixture_options(0.02));
}

TEST(Mixture, ShuffledSweeps) {
  PointCloud sweep = simulated_drive(1)[0].cloud;
  sweep.fields.clear();
  std::shuffle(sweep.positions.begin(), sweep.positions.end(), std::mt19937(1));
  check_mixture_round_trip({sweep}, mixture_options(0.05));
}

TEST(Mixture, AMillionPoints) {
  check_mixture_round_trip({random_sphere(1'000'000, 30, 5)}, mixture_options(0.1));
}

TEST(Mixture, GivesTheSameBytesForAnyNumberOfThreads) {
  const auto sweeps = clouds_of(simulated_drive(2, SensorKind::hdl_64e));
  const auto options = mixture_options(0.02);
  const auto one = encode_all(sweeps, options, {}, 1);
  for (const int threads : {2, 3, 8}) {
    const auto many = encode_all(sweeps, options, {}, threads);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(serialize(many[i]), serialize(one[i]));
  }
}

TEST(Mixture, TheFirstSweepOfAGroupBringsTheModelForTheOthers) {
  const auto sweeps = clouds_of(simulated_drive(5));
  const auto options = mixture_options(0.02, 2);
  const auto packets = encode_all(sweeps, options);
  ASSERT_EQ(packets.size(), 5u);
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(packets[i].group, i / 2);
    EXPECT_EQ(packets[i].kind, i % 2 == 0 ? FrameKind::key : FrameKind::predicted);
    EXPECT_EQ(packets[i].reference_frame, i - i % 2);
  }
  // A lost key frame costs its group, no more.
  const std::vector<Packet> arrived = {packets[1], packets[2], packets[3]};
  const auto decoded = decoder_of(options).decode(arrived);
  EXPECT_FALSE(decoded[0]);
  EXPECT_TRUE(decoded[1]);
  EXPECT_TRUE(decoded[2]);
}

TEST(Mixture, WithoutTimeEachSweepDecodesFromItsKeyFrameAlone) {
  const auto sweeps = clouds_of(simulated_drive(3));
  auto options = mixture_options(0.02);
  options.mixture.temporal = false;
  const auto packets = encode_all(sweeps, options);
  const auto whole = decoder_of(options).decode(packets);
  const auto alone = decoder_of(options).decode(std::vector<Packet>{packets[0], packets[2]});
  ASSERT_TRUE(alone[1]);
  EXPECT_EQ(alone[1]->cloud.positions, whole[2]->cloud.positions);
}

TEST(Mixture, FieldsAsSelected) {
  PointCloud sweep = simulated_drive(1)[0].cloud;
  ASSERT_NE(sweep.find_field("intensity"), nullptr);
  std::vector<std::uint32_t> numbers(sweep.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  sweep.fields.push_back({"number", numbers});

  EncoderOptions options = mixture_options(0.02);
  options.mixture.fields = {false, {{"intensity", 0.02}}};
  auto decoded = decoder_of(options).decode(encode_all({sweep}, options));
  ASSERT_TRUE(decoded[0]);
  ASSERT_EQ(decoded[0]->cloud.fields.size(), 1u);
  const auto& original = std::get<std::vector<float>>(sweep.find_field("intensity")->values);
  const auto& lossy = std::get<std::vector<float>>(decoded[0]->cloud.fields[0].values);
  ASSERT_TRUE(decoded[0]->order_kept);
  for (std::size_t i = 0; i < original.size(); ++i) ASSERT_NEAR(lossy[i], original[i], 0.02);

  options.mixture.fields = {true, {}};
  check_mixture_round_trip({sweep}, options);
  options.mixture.fields = {false, {}};
  decoded = decoder_of(options).decode(encode_all({sweep}, options));
  EXPECT_TRUE(decoded[0]->cloud.fields.empty());
}

TEST(Mixture, RefusesBoundsItCannotHold) {
  for (const double bound_m : {0.0, 0.0004, 1.1, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto encoder = Encoder::create(mixture_options(bound_m));
    ASSERT_FALSE(encoder);
    EXPECT_NE(encoder.error().message.find("max-error"), std::string::npos);
  }
  EXPECT_FALSE(Encoder::create(mixture_options(0.02, 0)));
  EXPECT_FALSE(Encoder::create(mixture_options(0.02, 256)));
}

// A sweep of a made-up sensor: rows and columns on a grid, ranges of a wavy world, and everything that goes
// wrong with sweeps.
PointCloud made_up_sweep() {
  const int rows = *rc::gen::inRange(1, 24);
  const int columns = *rc::gen::inRange(1, 400);
  const bool by_column = *rc::gen::arbitrary<bool>();
  const double noise_m = *rc::gen::element(0.0, 0.002, 0.05);
  const double range_m = *rc::gen::element(0.5, 8.0, 200.0);
  const int strays = *rc::gen::inRange(0, 20);
  const int percent = *rc::gen::inRange(0, 101);
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  std::normal_distribution<double> noise(0, noise_m + 1e-9);
  PointCloud cloud;
  for (int i = 0; i < rows * columns; ++i) {
    if (static_cast<int>(random() % 100) >= percent) continue;
    const int row = by_column ? i % rows : i / columns;
    const int column = by_column ? i / rows : i % columns;
    const double azimuth = 6.283185307 * (column + 0.3) / columns;
    const double slope = 0.1 - 0.03 * row;
    const double rho = range_m * (1.5 + std::sin(3 * azimuth) * std::cos(0.4 * row)) + noise(random);
    cloud.positions.push_back({static_cast<float>(rho * std::cos(azimuth) + noise(random)),
                               static_cast<float>(rho * std::sin(azimuth) + noise(random)),
                               static_cast<float>(rho * slope + 0.2 + noise(random))});
  }
  for (int i = 0; i < strays && !cloud.positions.empty(); ++i) {
    const std::size_t at = random() % cloud.size();
    const float scale = static_cast<float>(random() % 1000) / 100;
    Point3f p = cloud.positions[random() % cloud.size()];
    if (i % 5 == 0) p = {};
    if (i % 5 == 1) p = {scale * p.y, p.x, scale};
    if (i % 7 == 6) p.z = std::numeric_limits<float>::quiet_NaN();
    cloud.positions.insert(cloud.positions.begin() + static_cast<std::ptrdiff_t>(at), p);
  }
  return cloud;
}

RC_GTEST_PROP(AnySweeps, KeepBoundCountAndOrder, ()) {
  std::vector<PointCloud> sweeps(static_cast<std::size_t>(*rc::gen::inRange(1, 4)));
  for (PointCloud& sweep : sweeps) sweep = made_up_sweep();
  auto options = mixture_options(*rc::gen::element(0.0005, 0.001, 0.02, 0.3, 1.0), *rc::gen::inRange(1, 3));
  check_mixture_round_trip(sweeps, options);
}

RC_GTEST_PROP(AnyClouds, KeepBoundAndCount, ()) {
  const auto points = *rc::gen::inRange<std::size_t>(0, 3000);
  const auto range_m = *rc::gen::element(0.01F, 2.0F, 50.0F, 3000.0F, 1e7F);
  check_mixture_round_trip({random_sphere(points, range_m, *rc::gen::arbitrary<std::uint32_t>())},
                           mixture_options(*rc::gen::element(0.0005, 0.02, 1.0)));
}

}  // namespace
}  // namespace pointreel
