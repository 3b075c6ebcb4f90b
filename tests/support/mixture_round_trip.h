// Sweeps through method `mixture`, with everything checked that it promises.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "pointreel/io.h"
#include "support/codec_round_trip.h"
#include "support/distance.h"

namespace pointreel {

inline EncoderOptions mixture_options(double max_error_m, int group = 10) {
  EncoderOptions options;
  options.mixture.max_error_m = max_error_m;
  options.mixture.group = group;
  return options;
}

// Planes on the sensor's grid.
inline EncoderOptions sensor_planes(double max_error_m, Effort effort = Effort::balanced, int group = 10) {
  EncoderOptions options = mixture_options(max_error_m, group);
  options.method = Method::planes;
  options.mixture.effort = effort;
  return options;
}

// Every finite point is there, once, within the bound; fields came to the bit where the order says which is
// whose.
inline void check_mixture_sweep(const StreamHeader& header, const PointCloud& original, const Packet& packet,
                                const DecodedSweep& decoded) {
  const std::size_t finite = original.size() - original.count_non_finite();
  EXPECT_EQ(packet.points_in, original.size());
  EXPECT_EQ(packet.non_finite, original.count_non_finite());
  EXPECT_EQ(packet.points_out, finite);
  ASSERT_EQ(decoded.cloud.size(), finite);
  const auto pairs = pair_points(header, original, decoded);
  ASSERT_TRUE(pairs) << pairs.error().message;
  std::vector<int> owners(finite);
  std::int64_t next = 0;
  for (std::size_t i = 0; i < original.size(); ++i) {
    if (!is_finite(original.positions[i])) {
      EXPECT_EQ((*pairs)[i], -1);
      continue;
    }
    ASSERT_GE((*pairs)[i], 0) << "point " << i << " was lost";
    if (decoded.order_kept) {
      ASSERT_EQ((*pairs)[i], next++);
    }
    const auto pair = static_cast<std::size_t>((*pairs)[i]);
    ++owners[pair];
    ASSERT_LE(distance_between_m(original.positions[i], decoded.cloud.positions[pair]), header.max_error_m)
        << "point " << i;
  }
  EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), static_cast<std::ptrdiff_t>(finite));
  ASSERT_EQ(decoded.cloud.fields.size(), original.fields.size());
  for (std::size_t f = 0; f < original.fields.size(); ++f) {
    EXPECT_EQ(decoded.cloud.fields[f].name, original.fields[f].name);
    EXPECT_EQ(decoded.cloud.fields[f].size(), finite);
    if (decoded.order_kept && finite == original.size()) {
      EXPECT_EQ(decoded.cloud.fields[f], original.fields[f]);
    }
  }
}

inline std::vector<DecodedSweep> check_mixture_round_trip(const std::vector<PointCloud>& sweeps,
                                                          const EncoderOptions& options) {
  const auto packets = encode_all(sweeps, options);
  EXPECT_EQ(packets.size(), sweeps.size());
  std::vector<DecodedSweep> result;
  auto decoded = decoder_of(options).decode(packets);
  for (std::size_t i = 0; i < packets.size() && i < decoded.size(); ++i) {
    EXPECT_EQ(packets[i].frame, i);
    EXPECT_TRUE(decoded[i]) << (decoded[i] ? "" : decoded[i].error().message);
    if (!decoded[i]) continue;
    check_mixture_sweep(header_of(options), sweeps[i], packets[i], *decoded[i]);
    result.push_back(*std::move(decoded[i]));
  }
  return result;
}

// The same for files, one in memory at a time; each sweep that kept the promises is shown to `see`.
inline void check_mixture_files(
    std::span<const std::filesystem::path> paths, const EncoderOptions& options,
    const std::function<void(const Packet& packet, const DecodedSweep& decoded)>& see) {
  auto encoder = Encoder::create(options);
  ASSERT_TRUE(encoder) << encoder.error().message;
  auto decoder = decoder_of(options);
  for (const auto& path : paths) {
    SCOPED_TRACE(path.string() + " at " + std::to_string(options.mixture.max_error_m));
    const auto cloud = read_cloud(path);
    ASSERT_TRUE(cloud) << cloud.error().message;
    const auto packets = encoder->encode(*cloud);
    ASSERT_TRUE(packets) << packets.error().message;
    const auto decoded = decoder.decode(*packets);
    ASSERT_TRUE(decoded[0]) << decoded[0].error().message;
    ASSERT_NO_FATAL_FAILURE(check_mixture_sweep(encoder->header(), *cloud, packets->front(), *decoded[0]));
    see(packets->front(), *decoded[0]);
  }
}

}  // namespace pointreel
