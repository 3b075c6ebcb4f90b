// Thousands of variations of a good reel: damaged in transit, or by someone who knows about checksums.
#include <ostream>
#include <random>

#include "survival.h"

namespace pointreel {
namespace {

struct Sample {
  const char* name;
  EncoderOptions options;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.name;
}

class DamagedReels : public testing::TestWithParam<Sample> {
 protected:
  std::size_t below(std::size_t limit) { return random_() % limit; }

  // A reel with one packet's payload changed and all checksums right: the damage reaches the range decoder.
  template <class Change>
  Outcome survive_payload(const Change& change) {
    std::vector<Packet> packets = reel_.packets;
    change(packets[below(packets.size())].payload);
    return survive(reel_of(reel_.header, packets));
  }

  const SampleReel reel_{GetParam().options};
  const std::string whole_ = reel_.bytes();
  std::mt19937 random_{20201024};
};

TEST_P(DamagedReels, TheWholeOneIsFine) {
  const Outcome outcome = survive(whole_);
  EXPECT_TRUE(outcome.undamaged());
  EXPECT_EQ(outcome.sweeps, 6u);
}

TEST_P(DamagedReels, CutOff) {
  for (int i = 0; i < 150; ++i) {
    const Outcome outcome = survive(whole_.substr(0, below(whole_.size())));
    EXPECT_FALSE(outcome.undamaged());
    EXPECT_EQ(outcome.errors, 0u) << "packets before a cut are whole";
  }
}

TEST_P(DamagedReels, FlippedBits) {
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole_;
    for (std::size_t flips = 1 + below(3); flips > 0; --flips) {
      bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
    }
    const Outcome outcome = survive(bytes);
    EXPECT_TRUE(bytes == whole_ || !outcome.undamaged());
  }
}

TEST_P(DamagedReels, MissingRepeatedAndForeignBytes) {
  for (int i = 0; i < 100; ++i) {
    const std::size_t at = below(whole_.size());
    const std::size_t length = 1 + below(whole_.size() - at);
    EXPECT_FALSE(survive(whole_.substr(0, at) + whole_.substr(at + length)).undamaged());
    EXPECT_FALSE(survive(whole_.substr(0, at + length) + whole_.substr(at)).undamaged());
    EXPECT_FALSE(
        survive(whole_.substr(0, at) + std::string(length, static_cast<char>(random_())) + whole_.substr(at))
            .undamaged());
  }
}

TEST_P(DamagedReels, PayloadBitsFlippedUnderGoodChecksums) {
  for (int i = 0; i < 200; ++i) {
    survive_payload([&](std::vector<std::uint8_t>& payload) {
      for (std::size_t flips = 1 + below(4); flips > 0; --flips) {
        payload[below(payload.size())] ^= static_cast<std::uint8_t>(1 << below(8));
      }
    });
  }
}

TEST_P(DamagedReels, PayloadsCutAndGrownUnderGoodChecksums) {
  for (int i = 0; i < 80; ++i) {
    survive_payload([&](std::vector<std::uint8_t>& payload) { payload.resize(below(payload.size())); });
    survive_payload([&](std::vector<std::uint8_t>& payload) {
      payload.resize(payload.size() + below(200), static_cast<std::uint8_t>(random_()));
    });
  }
}

TEST_P(DamagedReels, RandomPayloadsUnderGoodChecksums) {
  for (int i = 0; i < 120; ++i) {
    const bool keep_start = i % 2 == 0;  // pose and rows stay: the damage is in what is range coded
    survive_payload([&](std::vector<std::uint8_t>& payload) {
      for (std::size_t at = keep_start ? std::min<std::size_t>(28, payload.size()) : 0; at < payload.size();
           ++at) {
        payload[at] = static_cast<std::uint8_t>(random_());
      }
    });
  }
}

TEST_P(DamagedReels, PayloadsOfOtherFrames) {
  for (int i = 0; i < 60; ++i) {
    const Packet& other = reel_.packets[below(reel_.packets.size())];
    survive_payload([&](std::vector<std::uint8_t>& payload) { payload = other.payload; });
  }
}

TEST_P(DamagedReels, PacketsInAnyOrderAndNumber) {
  for (int i = 0; i < 100; ++i) {
    std::vector<Packet> packets;
    for (std::size_t count = below(20); count > 0; --count) {
      Packet packet = reel_.packets[below(6)];
      if (below(4) == 0) packet.reference_frame = packet.frame + 1 + static_cast<std::uint32_t>(below(3));
      packet.kind = packet.reference_frame == packet.frame ? FrameKind::key : FrameKind::predicted;
      packets.push_back(std::move(packet));
    }
    const Outcome outcome = survive(reel_of(reel_.header, packets));
    EXPECT_EQ(outcome.ending, ReelEnding::complete);
    EXPECT_EQ(outcome.sweeps + outcome.errors, packets.size());
  }
}

// Another grid, tile size or step than the packets were made with.
TEST_P(DamagedReels, OtherValidHeaders) {
  for (int i = 0; i < 150; ++i) {
    StreamHeader header = reel_.header;
    header.max_error_m = 0.0005 + 0.001 * static_cast<double>(below(999));
    header.planes.tile_size = static_cast<int>(2 + below(15));
    if (i % 2 == 0) header.planes.azimuth_step_rad = 0.0003 + 0.00001 * static_cast<double>(below(9000));
    if (i % 3 == 0) header.planes.elevation_step_rad = 0.0003 + 0.00001 * static_cast<double>(below(9000));
    if (i % 5 == 0) header.planes.threshold_m = 0.001 + 0.001 * static_cast<double>(below(9999));
    if (i % 7 == 0) {
      const bool raw = header.planes.residual_mode == ResidualMode::raw_float;
      header.planes.residual_mode = raw ? ResidualMode::stepped : ResidualMode::raw_float;
      header.planes.residual_step_m = raw ? 20.0 : 0.0;
    }
    survive(reel_of(header, reel_.packets));
  }
}

INSTANTIATE_TEST_SUITE_P(Hostile, DamagedReels,
                         testing::Values(Sample{"Stepped", planes_sample(ResidualMode::stepped)},
                                         Sample{"Raw", planes_sample(ResidualMode::raw_float)},
                                         Sample{"SensorPlanes", sensor_planes_sample()},
                                         Sample{"Mixture", mixture_sample(0.02)},
                                         Sample{"MixtureFine", mixture_sample(0.0005)}),
                         [](const auto& sample) { return std::string(sample.param.name); });

}  // namespace
}  // namespace pointreel
