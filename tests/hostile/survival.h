// Reads and decodes any bytes as the tool does, and checks that nothing worse than an Error comes of it.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <string>
#include <vector>

#include "common/packet_batches.h"
#include "support/clouds.h"
#include "support/codec_round_trip.h"
#include "support/reels.h"

namespace pointreel {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;  // slower, and with memory of its own
#else
inline constexpr bool kSanitized = false;
#endif

// A few seconds each at most in release; a hang is what this is to find.
inline constexpr double kMaxSeconds = kSanitized ? 150 : 15;
inline constexpr long kMaxResident_kB = 1 << 20;

struct Outcome {
  bool opened = false;
  std::size_t sweeps = 0, errors = 0;
  ReelEnding ending = ReelEnding::open;

  bool undamaged() const { return opened && errors == 0 && ending == ReelEnding::complete; }
};

inline void expect_valid(const Packet& packet, const DecodedSweep& sweep) {
  EXPECT_EQ(sweep.frame, packet.frame);
  EXPECT_EQ(sweep.cloud.size(), packet.points_out);
  EXPECT_EQ(sweep.cloud.count_non_finite(), 0u);
  EXPECT_TRUE(sweep.T_key_sensor.matrix().allFinite());
}

inline void expect_valid_planes(const std::vector<Result<SweepPlanes>>& sweeps) {
  const SweepPlanes* before = nullptr;
  for (const auto& sweep : sweeps) {
    if (!sweep) {
      EXPECT_FALSE(sweep.error().message.empty());
      continue;
    }
    for (const PlaneTile& tile : sweep->tiles) {
      EXPECT_LT(tile.plane, sweep->planes.size());
      EXPECT_TRUE(tile.center_m.allFinite());
    }
    if (before != nullptr) {
      if (const auto motion = register_planes(*before, *sweep)) {
        EXPECT_TRUE(motion->T_ref_cur.matrix().allFinite());
      }
    }
    before = &*sweep;
  }
}

inline Outcome decode_reel(const std::string& bytes) {
  Outcome outcome;
  std::istringstream stream(bytes);
  auto reader = ReelReader::open(stream, "hostile.reel");
  if (!reader) {
    EXPECT_FALSE(reader.error().message.empty());
    return outcome;
  }
  auto decoder = Decoder::create(reader->header(), Runtime{2});
  EXPECT_TRUE(decoder) << "a header that was parsed is one to decode with";
  if (!decoder) return outcome;
  outcome.opened = true;

  auto planes_decoder = Decoder::create(reader->header(), Runtime{2});
  PacketBatches batches(*reader, 2);
  for (auto batch = batches.next(); !batch.empty(); batch = batches.next()) {
    const auto sweeps = decoder->decode(batch);
    EXPECT_EQ(sweeps.size(), batch.size());
    expect_valid_planes(planes_decoder->decode_planes(batch));
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      sweeps[i] ? ++outcome.sweeps : ++outcome.errors;
      if (sweeps[i]) expect_valid(batch[i], *sweeps[i]);
    }
  }
  outcome.ending = reader->ending();
  EXPECT_NE(outcome.ending, ReelEnding::open);
  EXPECT_EQ(outcome.ending == ReelEnding::cut_off, reader->fault().has_value());
  // By the index, too: it must lead to packets or to errors.
  if (const auto index = reader->index()) {
    for (const ReelIndexEntry& entry : index->entries) {
      EXPECT_TRUE(reader->seek(entry));
      reader->read_packet();
    }
  }
  // And past every damage, as far as there are bytes.
  std::istringstream again(bytes);
  auto resumed = ReelReader::open(again, "hostile.reel");
  do {
    while (resumed->read_packet()) {
    }
  } while (resumed->resume());
  return outcome;
}

// decode_reel within the limits of time and memory.
inline Outcome survive(const std::string& bytes) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = decode_reel(bytes);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kMaxSeconds);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  if (!kSanitized) {
    EXPECT_LT(usage.ru_maxrss, kMaxResident_kB);
  }
  return outcome;
}

// Every eighth turn of the sensor's rows: damage is found faster in small sweeps.
inline PointCloud thinned(const PointCloud& cloud) {
  PointCloud part;
  for (const Field& field : cloud.fields) part.fields.push_back({field.name, field.values});
  const auto keep = [&](std::size_t i) { return i % 128 < 16; };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (keep(i)) part.positions.push_back(cloud.positions[i]);
  }
  for (Field& field : part.fields) {
    std::visit(
        [&](auto& values) {
          std::size_t next = 0;
          for (std::size_t i = 0; i < cloud.size(); ++i) {
            if (keep(i)) values[next++] = values[i];
          }
          values.resize(next);
        },
        field.values);
  }
  return part;
}

inline EncoderOptions planes_sample(ResidualMode mode) {
  EncoderOptions options;
  options.method = Method::planes;
  options.planes.grid = PlaneGrid::uniform;
  options.planes.group = 3;
  options.planes.azimuth_step_rad = options.planes.elevation_step_rad = 0.035;
  options.planes.residual_mode = mode;
  return options;
}
inline EncoderOptions mixture_sample(double max_error_m) {
  EncoderOptions options;
  options.mixture.group = 3;
  options.mixture.max_error_m = max_error_m;
  return options;
}

inline EncoderOptions sensor_planes_sample() {
  EncoderOptions options = mixture_sample(0.1);
  options.method = Method::planes;
  return options;
}

// A short simulated drive in two groups of three. On the sensor's grid one sweep has no order, so that both
// ways of coding occur.
struct SampleReel {
  EncoderOptions options;
  StreamHeader header;
  std::vector<Packet> packets;

  explicit SampleReel(const EncoderOptions& chosen) : options(chosen), header(header_of(chosen)) {
    const auto drive = simulated_drive(6);
    auto clouds = clouds_of(drive);
    for (PointCloud& cloud : clouds) {
      if (header.on_sensor_grid()) cloud = thinned(cloud);
    }
    if (header.on_sensor_grid()) clouds[2] = random_sphere(300, 5, 1);
    packets = encode_all(clouds, options, poses_of(drive));
  }
  std::string bytes() const { return reel_of(header, packets); }
};

}  // namespace pointreel
