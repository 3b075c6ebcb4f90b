// SweepAlignment: the encoder's motion from the last decoded sweep to the next one.
#pragma once

#include <optional>
#include <vector>

#include "codec/measured_grid.h"
#include "motion/registration.h"
#include "predict/coding_grid.h"

namespace pointreel {

class SweepAlignment {
 public:
  // The sweep that the next ones are registered against, as it was decoded; `image` has its coding layout.
  void set_reference(const SensorModel& model, const SweepGrid& grid, const GridImage& image,
                     const std::optional<Pose>& T_world_sensor) {
    const CodingGrid coding(model, grid);
    reference_.emplace(model, grid);
    reference_m_ = coding.ranges_of_cells(image, 1);
    T_world_reference_ = T_world_sensor;
  }
  // After a sweep that the next one cannot follow on.
  void forget() {
    reference_.reset();
    motion_.reset();
  }

  // Coordinates of the current sweep to those of the reference, both as measured; none when the two cannot be
  // registered. Given poses are where the search begins, else the motion before.
  std::optional<Pose> align(const SensorModel& model, const GriddedSweep& sweep,
                            const std::optional<Pose>& T_world_sensor) {
    if (!reference_) return std::nullopt;
    std::optional<Pose> guess = motion_;
    if (T_world_reference_ && T_world_sensor) guess = T_world_reference_->inverse() * *T_world_sensor;
    const MeasuredGrid current(model, sweep.grid);
    const auto current_m = ranges_by_cell(model, sweep);
    const Registration registration =
        register_sweeps(reference_->with(reference_m_), current.with(current_m), guess);
    motion_.reset();
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
