// MotionPerTurn: which way the sensor turns, and how much of the motion between sweeps falls into a turn
// (SweepMotion::per_turn), learnt from the registrations themselves. Surfaces to the left and right of the
// way tell: where the sensor turns counterclockwise, those to the left seem to come a bit faster than those
// to the right.
#pragma once

#include <algorithm>

namespace pointreel {

// What a registration says: how much more it should be, with which weight (m^2).
struct TurnEvidence {
  double more = 0;
  double weight = 0;
};

class MotionPerTurn {
 public:
  double value() const { return value_; }

  void learn(const TurnEvidence& evidence) {
    // Each patch keeps half to the partner that the last value gave it.
    constexpr double kLead = 2;
    constexpr double kKept = 0.9;
    if (!(evidence.weight > 0)) return;
    weight_m2_ = kKept * weight_m2_ + evidence.weight;
    value_ = std::clamp(value_ + kLead * evidence.weight / weight_m2_ * evidence.more, -1.0, 1.0);
  }

 private:
  // At first 0, off by a half: patches are off by 3 cm.
  double value_ = 0;
  double weight_m2_ = (0.03 / 1) * (0.03 / 1);
};

}  // namespace pointreel
