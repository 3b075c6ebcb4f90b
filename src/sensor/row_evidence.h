// Which points of a cloud one laser measured, before anything is known of the sensor.
#pragma once

#include <cstdint>
#include <vector>

#include "pointreel/point_cloud.h"
#include "sensor/polar_points.h"
#include "sensor/tick_lattice.h"

namespace pointreel {

struct RowEvidence {
  RowPoints points;                // for each row, in any order of rows
  std::vector<std::int32_t> ring;  // of each row; empty without a ring field
};

// The best first.
enum class EvidenceKind : std::uint8_t { ring, runs, elevations };

// Rows from the cloud's ring field, from runs once around, or from clusters of elevation. None has more than
// kMaxRows rows or a row without points; no rows when the cloud does not offer this kind.
RowEvidence find_row_evidence(EvidenceKind kind, const PointCloud& cloud, const PolarPoints& polar);

}  // namespace pointreel
