// Sweeps through Encoder and Decoder, with everything checked that method `planes` promises on its uniform
// grid.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "pointreel/codec.h"
#include "pointreel/simulator.h"

namespace pointreel {

// Method `planes` on its uniform grid.
inline EncoderOptions planes_options() {
  EncoderOptions options;
  options.method = Method::planes;
  options.planes.grid = PlaneGrid::uniform;
  return options;
}

// Packets in stream order. `poses` is empty or has one for each sweep.
inline std::vector<Packet> encode_all(const std::vector<PointCloud>& sweeps, const EncoderOptions& options,
                                      const std::vector<Pose>& poses = {}, int threads = 2) {
  auto encoder = Encoder::create(options, Runtime{threads});
  if (!encoder) {
    ADD_FAILURE() << encoder.error().message;
    return {};
  }
  std::vector<Packet> packets;
  const auto take = [&](Result<std::vector<Packet>> made) {
    ASSERT_TRUE(made) << made.error().message;
    for (Packet& packet : *made) packets.push_back(std::move(packet));
  };
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    take(encoder->encode(sweeps[i], poses.empty() ? std::optional<Pose>{} : poses[i]));
  }
  take(encoder->finish());
  return packets;
}

// As the stream says it, with every default resolved.
inline StreamHeader header_of(const EncoderOptions& options) {
  return Encoder::create(options)->header();
}

inline Decoder decoder_of(const EncoderOptions& options, int threads = 2) {
  auto decoder = Decoder::create(header_of(options), Runtime{threads});
  return *std::move(decoder);
}

inline double distance_from_key_m(const Pose& T_key_sensor, const Point3f& p) {
  return (T_key_sensor * Eigen::Vector3d(p.x, p.y, p.z)).norm();
}

// Counts add up, each decoded point belongs to exactly one original, and the original is within the bound
// along the ray.
inline void check_sweep(const StreamHeader& header, const PointCloud& original, const Packet& packet,
                        const DecodedSweep& decoded) {
  EXPECT_EQ(packet.points_in, original.size());
  EXPECT_EQ(packet.non_finite, original.count_non_finite());
  EXPECT_EQ(packet.points_out, decoded.cloud.size());
  EXPECT_EQ(decoded.cloud.count_non_finite(), 0u);
  const auto pairs = pair_points(header, original, decoded);
  ASSERT_TRUE(pairs) << pairs.error().message;
  ASSERT_EQ(pairs->size(), original.size());

  std::vector<int> owners(decoded.cloud.size());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < original.size(); ++i) {
    const Point3f& p = original.positions[i];
    const std::int64_t pair = (*pairs)[i];
    if (!is_finite(p)) {
      EXPECT_EQ(pair, -1);
      continue;
    }
    if (pair < 0) {
      ++lost;
      continue;
    }
    ASSERT_LT(static_cast<std::size_t>(pair), owners.size());
    ++owners[static_cast<std::size_t>(pair)];
    const double range_m = distance_from_key_m(decoded.T_key_sensor, p);
    const double decoded_m =
        distance_from_key_m(decoded.T_key_sensor, decoded.cloud.positions[static_cast<std::size_t>(pair)]);
    // float32 positions: a few units in the last place of the range, and of the motion that was undone.
    const double rounding_m = 1e-6 * (range_m + decoded.T_key_sensor.translation().norm()) + 1e-6;
    ASSERT_LE(std::fabs(decoded_m - range_m), header.bound_m() + rounding_m) << "point " << i;
  }
  EXPECT_EQ(static_cast<std::size_t>(std::count(owners.begin(), owners.end(), 1)), owners.size())
      << "decoded points without an original, or with two";
  EXPECT_EQ(decoded.cloud.size() + lost + packet.non_finite, original.size());
}

// Encodes and decodes sweeps[i] as frame i, and checks each.
inline void check_round_trip(const std::vector<PointCloud>& sweeps, const EncoderOptions& options,
                             const std::vector<Pose>& poses = {}) {
  const auto packets = encode_all(sweeps, options, poses);
  ASSERT_EQ(packets.size(), sweeps.size());
  const auto decoded = decoder_of(options).decode(packets);
  ASSERT_EQ(decoded.size(), packets.size());
  std::map<std::uint32_t, int> frames;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    ASSERT_TRUE(decoded[i]) << decoded[i].error().message;
    EXPECT_EQ(decoded[i]->frame, packets[i].frame);
    ASSERT_LT(packets[i].frame, sweeps.size());
    ++frames[packets[i].frame];
    check_sweep(header_of(options), sweeps[packets[i].frame], packets[i], *decoded[i]);
  }
  EXPECT_EQ(frames.size(), sweeps.size()) << "a frame number was used twice";
}

inline std::vector<PointCloud> clouds_of(const std::vector<SimulatedSweep>& sweeps) {
  std::vector<PointCloud> clouds;
  clouds.reserve(sweeps.size());
  for (const SimulatedSweep& sweep : sweeps) clouds.push_back(sweep.cloud);
  return clouds;
}

inline std::vector<Pose> poses_of(const std::vector<SimulatedSweep>& sweeps) {
  std::vector<Pose> poses;
  poses.reserve(sweeps.size());
  for (const SimulatedSweep& sweep : sweeps) poses.push_back(sweep.T_world_sensor);
  return poses;
}

}  // namespace pointreel
