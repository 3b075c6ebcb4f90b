// Firing order: clouds whose points come as they were measured, column by column.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/raw_vector.h"

namespace pointreel {

struct FiringOrder {
  bool descending = false;       // the azimuth falls with time
  RawVector<float> azimuth_rad;  // per point, unwrapped: from 0, or a hair less, to 4 pi
};

// From azimuths in [0, 2 pi) in the order of the points; rows[i] < 0: no such point. None when the points do
// not go around once, or up to nearly twice, in small steps that change the row.
std::optional<FiringOrder> find_firing_order(std::span<const float> azimuth_rad,
                                             const std::vector<std::int16_t>& rows);

// How far each row's azimuth is ahead of the mean at the same firing, from the steps between successive
// points.
std::vector<double> row_leads_rad(std::span<const float> azimuth_rad, const std::vector<std::int16_t>& rows,
                                  std::size_t row_count);

}  // namespace pointreel
