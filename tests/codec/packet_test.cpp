#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "codec/wire.h"
#include "pointreel/codec.h"
#include "support/expect_error.h"

namespace pointreel {
namespace {

Packet sample_packet() {
  Packet packet;
  packet.frame = 7;
  packet.group = 2;
  packet.reference_frame = 5;
  packet.kind = FrameKind::predicted;
  packet.points_in = 1000;
  packet.points_out = 900;
  packet.non_finite = 20;
  packet.payload = {1, 2, 3, 0, 255, 128};
  return packet;
}

StreamHeader planes_header() {
  StreamHeader header;
  header.method = Method::planes;
  header.planes.grid = PlaneGrid::uniform;
  header.planes.residual_step_m = 0.2;
  return header;
}

void expect_same(const Packet& a, const Packet& b) {
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.group, b.group);
  EXPECT_EQ(a.reference_frame, b.reference_frame);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.points_in, b.points_in);
  EXPECT_EQ(a.points_out, b.points_out);
  EXPECT_EQ(a.non_finite, b.non_finite);
  EXPECT_EQ(a.payload, b.payload);
}

TEST(Packet, ComesBackAsSerialized) {
  const auto parsed = parse_packet(serialize(sample_packet()));
  ASSERT_TRUE(parsed) << parsed.error().message;
  expect_same(*parsed, sample_packet());
}

RC_GTEST_PROP(Packet, AnyPacketComesBack, ()) {
  Packet packet;
  packet.frame = *rc::gen::arbitrary<std::uint32_t>();
  packet.group = *rc::gen::arbitrary<std::uint32_t>();
  packet.kind = *rc::gen::element(FrameKind::key, FrameKind::predicted);
  packet.reference_frame = packet.kind == FrameKind::key ? packet.frame : packet.frame + 1;
  packet.points_out = *rc::gen::inRange<std::uint32_t>(0, 1u << 30);
  packet.non_finite = *rc::gen::inRange<std::uint32_t>(0, 1u << 30);
  packet.points_in = packet.points_out + packet.non_finite + *rc::gen::inRange<std::uint32_t>(0, 1u << 30);
  packet.payload = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
  const auto parsed = parse_packet(serialize(packet));
  RC_ASSERT(bool(parsed));
  expect_same(*parsed, packet);
}

// Any change of a byte is an Error, at whatever place and to whatever value.
template <class Parse>
void expect_every_change_to_fail(const std::vector<std::uint8_t>& valid, const Parse& parse) {
  ASSERT_TRUE(parse(valid));
  for (std::size_t at = 0; at < valid.size(); ++at) {
    for (int change = 1; change < 256; ++change) {
      auto bytes = valid;
      bytes[at] ^= static_cast<std::uint8_t>(change);
      const auto parsed = parse(bytes);
      ASSERT_FALSE(parsed) << "byte " << at << " changed by " << change;
      EXPECT_NE(parsed.error().code, ErrorCode::invalid_argument);
    }
  }
  for (std::size_t size = 0; size < valid.size(); ++size) {
    expect_error(parse(std::span(valid).first(size)), ErrorCode::truncated, "byte");
  }
  auto longer = valid;
  longer.push_back(0);
  expect_error(parse(longer), ErrorCode::corrupt, "bytes follow");
}

TEST(Packet, EveryChangedByteIsAnError) {
  expect_every_change_to_fail(serialize(sample_packet()), parse_packet);
}

TEST(StreamHeader, EveryChangedByteIsAnError) {
  expect_every_change_to_fail(serialize(StreamHeader{}), parse_stream_header);
  expect_every_change_to_fail(serialize(planes_header()), parse_stream_header);
}

// What a checksum does not catch, because whoever wrote the bytes computed it.
TEST(Packet, ContradictionsAreErrorsEvenWithAGoodChecksum) {
  Packet key_with_reference = sample_packet();
  key_with_reference.kind = FrameKind::key;
  expect_error(parse_packet(serialize(key_with_reference)), ErrorCode::corrupt, "contradict");

  Packet its_own_reference = sample_packet();
  its_own_reference.reference_frame = its_own_reference.frame;
  expect_error(parse_packet(serialize(its_own_reference)), ErrorCode::corrupt, "contradict");

  Packet unknown_kind = sample_packet();
  unknown_kind.kind = static_cast<FrameKind>(2);
  expect_error(parse_packet(serialize(unknown_kind)), ErrorCode::unsupported, "unknown packet kind 2");

  for (const auto& [out, non_finite] :
       {std::pair{1001u, 0u}, {0u, 1001u}, {900u, 101u}, {0xFFFFFFFFu, 0xFFFFFFFFu}}) {
    Packet too_many = sample_packet();
    too_many.points_out = out;
    too_many.non_finite = non_finite;
    expect_error(parse_packet(serialize(too_many)), ErrorCode::corrupt, "more points out than in");
  }
}

TEST(Packet, AHugeClaimedPayloadIsAnErrorBeforeItIsRead) {
  auto bytes = serialize(sample_packet());
  const std::uint32_t claim = kMaxPayloadBytes + 1;
  for (int i = 0; i < 4; ++i) bytes[4 + i] = static_cast<std::uint8_t>(claim >> (8 * i));
  expect_error(parse_packet(bytes), ErrorCode::corrupt, "too large at byte 4");
}

TEST(StreamHeader, OfMixtureComesBackAsSerialized) {
  StreamHeader header;
  header.max_error_m = 0.035;
  header.group = 17;
  const auto bytes = serialize(header);
  EXPECT_EQ(bytes.size(), kStreamHeaderBytes);
  const auto parsed = parse_stream_header(bytes);
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(parsed->method, Method::mixture);
  EXPECT_EQ(parsed->max_error_m, 0.035);
  EXPECT_EQ(parsed->group, 17);
}

TEST(StreamHeader, OfPlanesOnTheSensorsGridComesBackAsSerialized) {
  StreamHeader header;
  header.method = Method::planes;
  header.max_error_m = 0.07;
  header.group = 9;
  header.effort = Effort::max;
  auto bytes = serialize(header);
  EXPECT_EQ(bytes.size(), kStreamHeaderBytes);
  const auto parsed = parse_stream_header(bytes);
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(parsed->method, Method::planes);
  EXPECT_EQ(parsed->planes.grid, PlaneGrid::sensor);
  EXPECT_TRUE(parsed->on_sensor_grid());
  EXPECT_EQ(parsed->bound_m(), 0.07);
  EXPECT_EQ(parsed->group, 9);
  EXPECT_EQ(parsed->effort, Effort::max);
}

TEST(StreamHeader, OfPlanesComesBackAsSerialized) {
  StreamHeader header = planes_header();
  header.planes.threshold_m = 0.03;
  header.planes.azimuth_step_rad = 0.002;
  header.planes.elevation_step_rad = 0.007;
  header.planes.tile_size = 8;
  header.planes.group = 19;
  for (const auto mode : {ResidualMode::stepped, ResidualMode::raw_float}) {
    header.planes.residual_mode = mode;
    header.planes.residual_step_m = mode == ResidualMode::stepped ? 0.05 : 0;
    const auto bytes = serialize(header);
    EXPECT_EQ(bytes.size(), kStreamHeaderBytes);
    const auto parsed = parse_stream_header(bytes);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(parsed->method, Method::planes);
    EXPECT_EQ(parsed->planes.threshold_m, 0.03);
    EXPECT_EQ(parsed->planes.azimuth_step_rad, 0.002);
    EXPECT_EQ(parsed->planes.elevation_step_rad, 0.007);
    EXPECT_EQ(parsed->planes.tile_size, 8);
    EXPECT_EQ(parsed->planes.group, 19);
    EXPECT_EQ(parsed->planes.residual_mode, mode);
    EXPECT_EQ(parsed->planes.residual_step_m, header.planes.residual_step_m);
  }
}

TEST(StreamHeader, ValuesOutOfRangeAreErrorsEvenWithAGoodChecksum) {
  const auto parse_changed = [](const auto& change) {
    StreamHeader header = planes_header();
    change(header);
    return parse_stream_header(serialize(header));
  };
  const auto expect_corrupt = [&](const char* option, const auto& change) {
    expect_error(parse_changed(change), ErrorCode::corrupt, {"stream header: ", option});
  };
  expect_corrupt("method", [](StreamHeader& h) { h.method = static_cast<Method>(0); });
  expect_corrupt("threshold", [](StreamHeader& h) { h.planes.threshold_m = std::nan(""); });
  expect_corrupt("tile", [](StreamHeader& h) { h.planes.tile_size = 0; });
  expect_corrupt("group", [](StreamHeader& h) { h.planes.group = 0; });
  expect_corrupt("residual-step", [](StreamHeader& h) { h.planes.residual_step_m = 0; });
  expect_corrupt("residual-step", [](StreamHeader& h) { h.planes.residual_mode = ResidualMode{2}; });
  expect_corrupt("steps", [](StreamHeader& h) { h.planes.azimuth_step_rad = 1e-9; });
  expect_corrupt("steps", [](StreamHeader& h) { h.planes.elevation_step_rad = -1; });
  expect_corrupt("grid", [](StreamHeader& h) { h.planes.grid = PlaneGrid{2}; });
  const auto on_sensor_grid = [](StreamHeader& h) { h.planes.grid = PlaneGrid::sensor; };
  expect_corrupt("max-error", [&](StreamHeader& h) { on_sensor_grid(h), h.max_error_m = 2; });
  expect_corrupt("effort", [&](StreamHeader& h) { on_sensor_grid(h), h.effort = Effort{3}; });
  const auto of_mixture = [](StreamHeader& h) { h.method = Method::mixture; };
  expect_corrupt("max-error", [&](StreamHeader& h) { of_mixture(h), h.max_error_m = std::nan(""); });
  expect_corrupt("max-error", [&](StreamHeader& h) { of_mixture(h), h.max_error_m = 2; });
  expect_corrupt("group", [&](StreamHeader& h) { of_mixture(h), h.group = 0; });
}

}  // namespace
}  // namespace pointreel
