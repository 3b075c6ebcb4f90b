#include "sensor/tick_lattice.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>

#include "base/trigonometry.h"
#include "sensor/phase_bank.h"

namespace pointreel {
std::uint32_t find_ticks_per_turn(const PolarPoints& polar, const RowPoints& rows) {
  constexpr std::size_t kPairs = 1500;
  constexpr std::uint32_t kFewest = 90;
  constexpr std::uint32_t kMost = 40000;
  constexpr float kNearM = 2;
  // Two points of a row at about the same distance share their side offset's effect: their azimuths differ by
  // whole ticks, over the whole turn.
  struct Pair {
    double difference;
    float inverse_change;
  };
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> sorted;
  for (const auto& row : rows) {
    sorted.clear();
    for (const std::uint32_t i : row) {
      if (polar.rho_m[i] > kNearM) sorted.push_back(i);
    }
    std::sort(sorted.begin(), sorted.end(),
              [&](std::uint32_t a, std::uint32_t b) { return polar.rho_m[a] < polar.rho_m[b]; });
    for (std::size_t k = 1; k < sorted.size(); ++k) {
      const std::uint32_t a = sorted[k - 1];
      const std::uint32_t b = sorted[k];
      pairs.push_back({static_cast<double>(polar.azimuth_rad[b]) - static_cast<double>(polar.azimuth_rad[a]),
                       1 / polar.rho_m[a] - 1 / polar.rho_m[b]});
    }
  }
  if (pairs.size() < 100) return 0;
  if (pairs.size() > kPairs) {
    // Evenly over the rows, so that every row has its say.
    std::vector<Pair> kept;
    constexpr std::size_t kGroup = 4;
    const std::size_t stride = std::max<std::size_t>(1, pairs.size() / (kPairs * kGroup));
    for (std::size_t i = 0; i < pairs.size(); i += stride) kept.push_back(pairs[i]);
    const auto middle = kept.begin() + static_cast<std::ptrdiff_t>(std::min(kPairs, kept.size()));
    std::nth_element(kept.begin(), middle - 1, kept.end(),
                     [](const Pair& a, const Pair& b) { return a.inverse_change < b.inverse_change; });
    kept.erase(middle, kept.end());
    pairs = std::move(kept);
  }
  // A third of the pairs rules most numbers out.
  constexpr std::size_t kScouts = 3;
  constexpr double kHopeful = 0.6;
  PhaseBank scouts;
  std::vector<double> scores(kMost + 1, 0);
  double best = 0;
  constexpr std::uint32_t kRestart = 256;  // float rotations drift
  for (std::uint32_t n = kFewest; n <= kMost; ++n) {
    if ((n - kFewest) % kRestart == 0) {
      scouts.clear();
      for (std::size_t i = 0; i < pairs.size(); i += kScouts)
        scouts.add(n * pairs[i].difference, pairs[i].difference);
    }
    const auto sum = static_cast<double>(scouts.sum_and_turn().real());
    if (sum < kHopeful * static_cast<double>(scouts.size())) continue;
    double exact = 0;
    for (const Pair& pair : pairs) exact += std::cos(n * pair.difference);
    scores[n] = exact / static_cast<double>(pairs.size());
    best = std::max(best, scores[n]);
  }
  if (best < 0.75) return 0;
  // Multiples of the lattice's number score nearly as well; the smallest is the sensor's.
  for (std::uint32_t n = kFewest; n < kMost; ++n) {
    if (scores[n] > 0.85 * best && scores[n] >= scores[n + 1]) return n;
  }
  return 0;
}

RowAzimuth fit_row_azimuth(const PolarPoints& polar, const std::vector<std::uint32_t>& points,
                           std::uint32_t ticks_per_turn) {
  constexpr std::size_t kSamples = 700;
  constexpr double kMostSideM = 0.12;
  constexpr double kStepM = 0.001;
  const double n = ticks_per_turn;
  struct Sample {
    double azimuth, inverse;
    float weight;
  };
  std::vector<Sample> samples;
  const std::size_t stride = points.size() / kSamples + 1;
  for (std::size_t k = 0; k < points.size(); k += stride) {
    const std::uint32_t i = points[k];
    const double rho = polar.rho_m[i];
    if (rho < 1) continue;
    samples.push_back({static_cast<double>(polar.azimuth_rad[i]), 1 / rho, std::min(polar.rho_m[i], 30.0F)});
  }
  RowAzimuth fit;
  if (samples.size() < 4) return fit;
  // Coherence of the phases over all candidate offsets, by rotating each sample from one to the next.
  PhaseBank phases;
  float weights = 0;
  for (const Sample& s : samples) {
    phases.add(n * (s.azimuth + kMostSideM * s.inverse), -n * kStepM * s.inverse, s.weight);
    weights += s.weight;
  }
  const int candidates = static_cast<int>(2 * kMostSideM / kStepM) + 1;
  float most = -1;
  std::complex<float> mean;
  for (int c = 0; c < candidates; ++c) {
    const std::complex<float> sum = phases.sum_and_turn();
    // Without near points every offset looks alike: the smallest is taken.
    const float h = static_cast<float>(std::fabs(-kMostSideM + c * kStepM));
    const float coherence = std::sqrt(std::norm(sum)) / weights - 0.02F * h;
    if (coherence > most) {
      most = coherence;
      mean = sum;
      fit.side_offset_m = -kMostSideM + c * kStepM;
    }
  }
  fit.sharpness = static_cast<double>(std::abs(mean) / weights);
  double phase = std::atan2(static_cast<double>(mean.imag()), static_cast<double>(mean.real())) / n;
  // Least squares of the distances from the ticks: cross-range errors in metres, all points alike.
  const double tick = kTurn / n;
  for (int round = 0; round < 4; ++round) {
    const double limit = round == 0 ? 0.3 : 0.15;  // of a tick
    double s11 = 0, s12 = 0, s22 = 0, b1 = 0, b2 = 0;
    for (const std::uint32_t i : points) {
      const double rho = polar.rho_m[i];
      if (rho < 1) continue;
      const double turned =
          static_cast<double>(polar.azimuth_rad[i]) - std::atan(fit.side_offset_m / rho) - phase;
      const double away = std::remainder(turned, tick);
      if (std::fabs(away) > limit * tick) continue;
      const double weight = std::min(rho * rho, 900.0);
      s11 += weight;
      s12 += weight / rho;
      s22 += weight / (rho * rho);
      b1 += weight * away;
      b2 += weight * away / rho;
    }
    const double determinant = s11 * s22 - s12 * s12;
    if (!(s11 > 0)) break;
    if (determinant > 1e-4 * s11 * s22) {
      phase += (b1 * s22 - b2 * s12) / determinant;
      fit.side_offset_m += (b2 * s11 - b1 * s12) / determinant;
    } else {
      phase += b1 / s11;
    }
  }
  fit.phase_rad = phase;
  return fit;
}

namespace {

// std::popcount calls a function where the processor's instruction may not be used; this becomes SIMD code.
std::uint32_t count_bits(std::uint64_t bits) {
  bits -= (bits >> 1) & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + ((bits >> 2) & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<std::uint32_t>((bits * 0x0101010101010101u) >> 56);
}

// A set of ticks on the circle, rotated and counted 64 at a time.
class TickSet {
 public:
  explicit TickSet(std::uint32_t turn) : turn_(turn), words_(2 * turn / 64 + 2, 0) {}
  void insert(std::uint32_t tick) {
    for (const std::uint32_t t : {tick, tick + turn_}) words_[t / 64] |= std::uint64_t{1} << (t % 64);
  }
  // How many of `other`'s ticks, moved by shift in [0, turn), are in this set.
  std::uint32_t common(const TickSet& other, std::uint32_t shift) const {
    std::uint32_t count = 0;
    const std::uint32_t full = turn_ / 64;
    const std::uint32_t offset = shift % 64;
    const std::uint64_t* words = &words_[shift / 64];
    for (std::uint32_t w = 0; w <= full; ++w) {
      std::uint64_t here = words[w] >> offset;
      if (offset != 0) here |= words[w + 1] << (64 - offset);
      std::uint64_t mask = other.words_[w];
      if (w == full) mask &= (std::uint64_t{1} << (turn_ % 64)) - 1;
      count += count_bits(here & mask);
    }
    return count;
  }

 private:
  std::uint32_t turn_;
  std::vector<std::uint64_t> words_;
};

}  // namespace

std::vector<std::int32_t> align_rows(const std::vector<std::vector<std::uint32_t>>& ticks,
                                     std::uint32_t ticks_per_turn, std::uint32_t most_ticks) {
  const std::size_t rows = ticks.size();
  const std::uint32_t turn = ticks_per_turn;
  std::vector<std::int32_t> shifts(rows, 0);
  if (rows == 0 || turn == 0) return shifts;
  const auto most = static_cast<std::int32_t>(most_ticks);
  std::vector<TickSet> sets(rows, TickSet(turn));
  std::size_t fullest = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    for (const std::uint32_t tick : ticks[r]) sets[r].insert(tick);
    if (ticks[r].size() > ticks[fullest].size()) fullest = r;
  }
  TickSet reference = sets[fullest];
  for (int round = 0; round < 4; ++round) {
    bool changed = false;
    for (std::size_t r = 0; r < rows; ++r) {
      if (ticks[r].empty()) continue;
      std::vector<std::int32_t> common(static_cast<std::size_t>(2 * most + 3));
      for (std::int32_t s = -most - 1; s <= most + 1; ++s) {
        const auto shift = static_cast<std::uint32_t>(s < 0 ? s + static_cast<std::int32_t>(turn) : s);
        common[static_cast<std::size_t>(s + most + 1)] =
            static_cast<std::int32_t>(reference.common(sets[r], shift));
      }
      // Only how much better a shift is than its neighbours says something: what the row sees of the sky or
      // of a wall is common to all shifts nearby. A shift must beat none at all clearly.
      const auto gain = [&](std::int32_t s) {
        const auto k = static_cast<std::size_t>(s + most + 1);
        return 2 * common[k] - common[k - 1] - common[k + 1];
      };
      std::int32_t best = 0;
      const auto margin = static_cast<std::int32_t>(std::sqrt(static_cast<double>(ticks[r].size())) / 2);
      std::int32_t most_gain = gain(0) + margin;
      for (std::int32_t s = -most; s <= most; ++s) {
        if (gain(s) > most_gain) {
          most_gain = gain(s);
          best = s;
        }
      }
      changed = changed || best != shifts[r];
      shifts[r] = best;
    }
    if (!changed) break;
    // What many rows use is the pattern.
    std::vector<std::uint32_t> users(turn, 0);
    std::size_t total = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      for (const std::uint32_t tick : ticks[r]) {
        const auto moved = static_cast<std::int64_t>(tick) + shifts[r] + turn;
        ++users[static_cast<std::size_t>(moved % turn)];
        ++total;
      }
    }
    const auto used = static_cast<std::size_t>(
        std::count_if(users.begin(), users.end(), [](std::uint32_t count) { return count > 0; }));
    reference = TickSet(turn);
    for (std::uint32_t tick = 0; tick < turn; ++tick) {
      if (users[tick] * used >= total) reference.insert(tick);
    }
  }
  return shifts;
}

}  // namespace pointreel
