// SweepAlignment: the encoder's motion from one sweep to the next.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "codec/measured_grid.h"
#include "motion/registration.h"

namespace pointreel {

class SweepAlignment {
 public:
  // The sweep that the next one is registered against: as measured, for coarse steps of range bend the ground
  // the same way in every sweep, which looks like standing still (docs/REGISTRATION.md).
  void set_reference(const SensorModel& model, const GriddedSweep& sweep,
                     const std::optional<Pose>& T_world_sensor) {
    reference_.emplace(model, sweep.grid);
    reference_m_ = ranges_by_cell(model, sweep);
    T_world_reference_ = T_world_sensor;
  }

  // Coordinates of the current sweep to those of the reference, before motion compensation; none when the two
  // cannot be registered. Given poses are where the search begins, else the motion before.
  std::optional<Pose> align(const SensorModel& model, const GriddedSweep& sweep,
                            const std::optional<Pose>& T_world_sensor) {
    if (!reference_) return std::nullopt;
    std::optional<Pose> guess = std::exchange(motion_, std::nullopt);
    if (T_world_reference_ && T_world_sensor) guess = T_world_reference_->inverse() * *T_world_sensor;
    const MeasuredGrid current(model, sweep.grid);
    const auto current_m = ranges_by_cell(model, sweep);
    const Registration registration =
        register_sweeps(reference_->with(reference_m_), current.with(current_m), guess);
    if (registration.converged) motion_ = registration.T_ref_cur;
    return motion_;
  }

 private:
  std::optional<MeasuredGrid> reference_;
  std::vector<float> reference_m_;  // by cell of the sensor grid
  std::optional<Pose> T_world_reference_;
  std::optional<Pose> motion_;  // of the last step
};

}  // namespace pointreel
