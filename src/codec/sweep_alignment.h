// SweepAlignment: the encoder's motion from one sweep to the next.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/measured_grid.h"
#include "codec/relative_pose.h"
#include "motion/motion_per_turn.h"
#include "motion/registration.h"
#include "motion/sweep_motion.h"

namespace pointreel {

class SweepAlignment {
 public:
  // `registers`: false for the motion of the poses given, or without them none.
  explicit SweepAlignment(bool registers) : registers_(registers) {}

  // Takes the next sweep, its ranges by cell (ranges_by_cell()). The motion since the sweep before, before
  // motion compensation; none when it `is_key`, or when the two cannot be registered. Given poses are where
  // the search begins, else the motion before.
  //
  // Sweeps are registered as measured, which is a little better than as decoded (docs/REGISTRATION.md).
  std::optional<SweepMotion> follow(const SensorModel& model, const SweepGrid& grid,
                                    std::span<const float> range_of_cell_m,
                                    const std::optional<Pose>& T_world_sensor, bool is_key) {
    if (!registers_) {
      const auto before = std::exchange(T_world_reference_, T_world_sensor);
      if (is_key) return std::nullopt;
      const Pose given = before && T_world_sensor ? before->inverse() * *T_world_sensor : Pose::Identity();
      return quantised(given) ? std::optional(SweepMotion{given}) : std::nullopt;
    }
    std::vector<float> current_m(range_of_cell_m.begin(), range_of_cell_m.end());
    GridRays current(MeasuredGrid(model, grid).with(current_m));
    std::optional<SweepMotion> motion;
    if (!is_key && reference_) {
      std::optional<Pose> guess = last_motion_;
      if (T_world_reference_ && T_world_sensor) guess = T_world_reference_->inverse() * *T_world_sensor;
      const Registration registration = register_sweeps(*reference_, current, guess, per_turn_.value());
      last_motion_.reset();
      if (registration.converged) {
        last_motion_ = registration.T_ref_cur;
        motion = {registration.T_ref_cur, per_turn_.value()};
        per_turn_.learn(registration.turning);
      }
    }
    reference_ = std::move(current);
    reference_m_ = std::move(current_m);
    T_world_reference_ = T_world_sensor;
    return motion;
  }

 private:
  bool registers_;
  std::optional<GridRays> reference_;
  std::vector<float> reference_m_;  // that it looks at
  std::optional<Pose> T_world_reference_;
  std::optional<Pose> last_motion_;
  MotionPerTurn per_turn_;
};

}  // namespace pointreel
