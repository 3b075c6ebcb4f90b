// Random numbers with the same bits from every compiler (SplitMix64; std::normal_distribution is not
// portable).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace pointreel::sim {

// Finaliser of SplitMix64: neighbouring inputs give unrelated outputs.
constexpr std::uint64_t mix_bits(std::uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
  return v ^ (v >> 31);
}

// A seed for the part `key` of something seeded with `seed`.
constexpr std::uint64_t combine(std::uint64_t seed, std::uint64_t key) {
  return mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15u) ^ (key + 0x9e3779b97f4a7c15u));
}

constexpr double to_unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15u); }
  double uniform() { return to_unit_interval(bits()); }  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }

  // Standard normal (Box-Muller, both values used).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace pointreel::sim
