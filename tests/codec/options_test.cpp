// What Encoder and Decoder refuse, and that they say which option it is.
#include <gtest/gtest.h>

#include <limits>

#include "pointreel/codec.h"
#include "support/clouds.h"
#include "support/codec_round_trip.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Change>
Result<Encoder> encoder_with(const Change& change) {
  EncoderOptions options = planes_options();
  change(options.planes);
  return Encoder::create(options);
}

template <class Change>
Result<Encoder> mixture_encoder_with(const Change& change) {
  EncoderOptions options;
  change(options.mixture);
  return Encoder::create(options);
}

TEST(EncoderOptions, DefaultsOfPlanesAreValidAndResolveTheResidualStep) {
  const auto encoder = Encoder::create(planes_options());
  ASSERT_TRUE(encoder);
  EXPECT_EQ(encoder->header().planes.residual_step_m, 0.2);
  EXPECT_EQ(encoder->header().bound_m(), 0.1);
}

TEST(EncoderOptions, MixtureIsTheDefaultWithABoundOf2cm) {
  const auto encoder = Encoder::create({});
  ASSERT_TRUE(encoder);
  EXPECT_EQ(encoder->header().method, Method::mixture);
  EXPECT_EQ(encoder->header().bound_m(), 0.02);
}

TEST(EncoderOptions, OutOfRangeValuesOfMixtureNameTheirOption) {
  for (const double bad : {0.0, -1.0, 0.0004, 1.1, kNan}) {
    expect_error(mixture_encoder_with([&](MixtureOptions& mixture) { mixture.max_error_m = bad; }),
                 ErrorCode::invalid_argument, "max-error must lie in 0.0005 to 1 m, got");
  }
  for (const int bad : {-1, 0, 256}) {
    expect_error(mixture_encoder_with([&](MixtureOptions& mixture) { mixture.group = bad; }),
                 ErrorCode::invalid_argument, "group must lie in 1 to 255 sweeps");
  }
  for (const double bad : {-0.1, kNan, std::numeric_limits<double>::infinity()}) {
    expect_error(mixture_encoder_with([&](MixtureOptions& mixture) {
                   mixture.fields.named = {{"intensity", bad}};
                 }),
                 ErrorCode::invalid_argument, "fields: the step of intensity");
  }
}

TEST(EncoderOptions, OutOfRangeValuesNameTheirOption) {
  for (const double bad : {0.0, -1.0, 0.0009, 10.1, kNan}) {
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.threshold_m = bad; }),
                 ErrorCode::invalid_argument, "threshold must lie in 0.001 to 10 m, got");
  }
  for (const int bad : {-1, 0, 1, 17}) {
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.tile_size = bad; }),
                 ErrorCode::invalid_argument, "tile must lie in 2 to 16 cells");
  }
  for (const int bad : {-1, 0, 256}) {
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.group = bad; }),
                 ErrorCode::invalid_argument, "group must lie in 1 to 255 sweeps");
  }
  for (const double bad : {-0.1, 0.0009, 20.1, kNan}) {
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.residual_step_m = bad; }),
                 ErrorCode::invalid_argument, "residual-step must lie in 0.001 to 20 m");
  }
  for (const double bad : {0.0, 0.2, kNan}) {
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.azimuth_step_rad = bad; }),
                 ErrorCode::invalid_argument, "azimuth and elevation steps");
    expect_error(encoder_with([&](PlanesOptions& planes) { planes.elevation_step_rad = bad; }),
                 ErrorCode::invalid_argument, "azimuth and elevation steps");
  }
  expect_error(encoder_with([](PlanesOptions& planes) {
                 planes.residual_mode = ResidualMode::raw_float;
                 planes.residual_step_m = 0.1;
               }),
               ErrorCode::invalid_argument, "residual-step");
}

TEST(EncoderOptions, UnknownMethodIsUnsupported) {
  EncoderOptions options;
  options.method = static_cast<Method>(99);
  expect_error(Encoder::create(options), ErrorCode::unsupported, "method 99");
}

TEST(Decoder, RefusesHeadersThatNoEncoderMakes) {
  const StreamHeader good = Encoder::create(planes_options())->header();
  EXPECT_TRUE(Decoder::create(good));
  StreamHeader bad = good;
  bad.planes.tile_size = 0;
  expect_error(Decoder::create(bad), ErrorCode::invalid_argument, "tile");
  expect_error(pair_points(bad, {}, {}), ErrorCode::invalid_argument, "tile");
  bad = good;
  bad.planes.threshold_m = kNan;
  expect_error(Decoder::create(bad), ErrorCode::invalid_argument, "threshold");
  bad = good;
  bad.planes.azimuth_step_rad = 1e-9;
  expect_error(Decoder::create(bad), ErrorCode::invalid_argument, "steps");
  bad = StreamHeader{};
  EXPECT_TRUE(Decoder::create(bad));
  bad.max_error_m = kNan;
  expect_error(Decoder::create(bad), ErrorCode::invalid_argument, "max-error");
  expect_error(pair_points(bad, {}, {}), ErrorCode::invalid_argument, "max-error");
}

TEST(RangeBound, IsTheWorseOfThresholdAndHalfTheResidualStep) {
  StreamHeader header;
  header.method = Method::planes;
  header.planes.grid = PlaneGrid::uniform;
  header.planes.threshold_m = 0.1;
  header.planes.residual_step_m = 0.05;
  EXPECT_EQ(header.bound_m(), 0.1);
  header.planes.residual_step_m = 0.5;
  EXPECT_EQ(header.bound_m(), 0.25);
  header.planes.residual_mode = ResidualMode::raw_float;
  EXPECT_EQ(header.bound_m(), 0.1);
}

TEST(Encoder, ANonsensePoseIsAnErrorNamingItsFrame) {
  EncoderOptions options = planes_options();
  options.planes.group = 3;
  auto encoder = Encoder::create(options);
  ASSERT_TRUE(encoder);
  const PointCloud cloud = random_sphere(100, 10, 1);
  Pose bad = Pose::Identity();
  bad.translation().x() = kNan;
  ASSERT_TRUE(encoder->encode(cloud, Pose::Identity()));
  ASSERT_TRUE(encoder->encode(cloud, Pose::Identity()));
  expect_error(encoder->encode(cloud, bad), ErrorCode::invalid_argument, "pose of frame 2");
}

TEST(Encoder, ASweepWhoseGridWouldBeHugeIsAnErrorNamingItsFrame) {
  EncoderOptions options = planes_options();
  options.planes.group = 1;
  options.planes.azimuth_step_rad = options.planes.elevation_step_rad = 0.0003;
  auto encoder = Encoder::create(options);
  ASSERT_TRUE(encoder);
  expect_error(encoder->encode(cloud_of_points({{0, 0, 1}, {0, 0, -1}})), ErrorCode::resource_limit,
               {"frame 0: ", "--azimuth-step"});
}

}  // namespace
}  // namespace pointreel
