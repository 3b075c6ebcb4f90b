#include "codec/corrections.h"

#include <cmath>
#include <string>

#include "entropy/adaptive_models.h"

namespace pointreel {
namespace {

// Gaps between corrected points, then three steps with a model each. Strictly ascending indices make every
// gap at least 1; a gap of 0 ends the list.
class CorrectionCoder {
 public:
  template <class Coder>
  std::uint32_t code_gap(Coder& coder, std::uint32_t gap) {
    return static_cast<std::uint32_t>(gap_.code(coder, static_cast<std::int32_t>(gap)));
  }
  template <class Coder>
  void code_steps(Coder& coder, std::array<std::int32_t, 3>& steps) {
    for (std::size_t axis = 0; axis < 3; ++axis) steps[axis] = step_[axis].code(coder, steps[axis]);
  }

 private:
  AdaptiveInteger gap_;
  std::array<AdaptiveInteger, 3> step_;
};

}  // namespace

double CorrectionSteps::reach_m() const {
  // Half a unit in the last place of coordinates in [2^(k-1), 2^k) is 2^(k-25).
  constexpr double kRoundingShare = 0.045 / 1.7320508075688772;
  return std::exp2(std::floor(std::log2(kRoundingShare * max_error_m_)) + 25);
}

Correction CorrectionSteps::between(std::uint32_t index, const Point3f& decoded,
                                    const Point3f& original) const {
  const auto steps = [this](float from, float to) {
    return static_cast<std::int32_t>(std::lround((static_cast<double>(to) - from) / edge_m_));
  };
  return {index, {steps(decoded.x, original.x), steps(decoded.y, original.y), steps(decoded.z, original.z)}};
}

Point3f CorrectionSteps::apply(const Point3f& decoded, const Correction& correction) const {
  const auto moved = [this](float from, std::int32_t steps) {
    return static_cast<float>(static_cast<double>(from) + static_cast<double>(steps) * edge_m_);
  };
  return {moved(decoded.x, correction.steps[0]), moved(decoded.y, correction.steps[1]),
          moved(decoded.z, correction.steps[2])};
}

std::vector<std::uint8_t> encode_corrections(std::span<const Correction> corrections) {
  if (corrections.empty()) return {};
  BitEncoder coder;
  CorrectionCoder models;
  std::uint32_t next = 0;
  for (Correction correction : corrections) {
    models.code_gap(coder, correction.index - next + 1);
    models.code_steps(coder, correction.steps);
    next = correction.index + 1;
  }
  models.code_gap(coder, 0);
  return coder.finish();
}

Result<std::vector<Correction>> decode_corrections(std::span<const std::uint8_t> bytes, std::size_t points) {
  std::vector<Correction> corrections;
  if (bytes.empty()) return corrections;
  BitDecoder coder(bytes);
  CorrectionCoder models;
  std::uint64_t next = 0;
  for (std::uint32_t gap = models.code_gap(coder, 0); gap != 0; gap = models.code_gap(coder, 0)) {
    const std::uint64_t index = next + gap - 1;
    if (index >= points || coder.overran()) {
      return Error{ErrorCode::corrupt,
                   "a correction names point " + std::to_string(index) + " of " + std::to_string(points)};
    }
    Correction correction{static_cast<std::uint32_t>(index), {}};
    models.code_steps(coder, correction.steps);
    corrections.push_back(correction);
    next = index + 1;
  }
  return corrections;
}

}  // namespace pointreel
