// MotionPerTurn: which way the sensor turns, and how much of the motion between sweeps falls into a turn
// (SweepMotion::per_turn), learnt from the registrations themselves. Surfaces to the left and right of the
// way tell: where the sensor turns counterclockwise, those to the left seem to come a bit faster than those
// to the right.
#pragma once

#include <algorithm>

namespace pointreel {

// What a registration says: how much more it should be, with which weight; weight 0: nothing.
struct TurnEvidence {
  double more = 0;
  double weight_m2 = 0;
};

class MotionPerTurn {
 public:
  double value() const { return value_; }

  void learn(const TurnEvidence& evidence) {
    // Each patch keeps half to the partner that the last value gave it.
    constexpr double kLead = 2;
    if (!(evidence.weight_m2 > 0)) return;
    weight_m2_ = std::min(weight_m2_, weight_of(kLeastOff)) + evidence.weight_m2;
    value_ = std::clamp(value_ + kLead * evidence.weight_m2 / weight_m2_ * evidence.more, -1.0, 1.0);
  }

 private:
  // How far off the value may be, at first and at least: it must follow when every second sweep is left out.
  static constexpr double kOffAtFirst = 1, kLeastOff = 0.12;
  // That of evidence which tells it but for `off`, when patches are off by 3 cm.
  static constexpr double weight_of(double off) { return 0.03 / off * (0.03 / off); }

  double value_ = 0;
  double weight_m2_ = weight_of(kOffAtFirst);
};

}  // namespace pointreel
