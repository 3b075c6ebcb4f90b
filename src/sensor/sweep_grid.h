// SweepGrid: the columns of one sweep, the order of its points, and its motion when that was compensated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/raw_vector.h"
#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"

namespace pointreel {

// KITTI's motion compensation, undone: q = R(s w) p + s v, with p the point of the file, q the point as
// measured, s = azimuth of q in (-pi, pi] over 2 pi. Multiples of kTwistStep.
struct Twist {
  std::array<double, 3> v_m{};
  std::array<double, 3> w_rad{};
  friend bool operator==(const Twist&, const Twist&) = default;
};
inline constexpr double kTwistStep =
    1.0 / (1 << 16);                     // of w, and of v in metres: 0.6 mm at s = 1/2, 80 m away
inline constexpr double kMaxTwist = 16;  // of every component

// What the order of the points follows from. Points that deviate from it are moved apart (order_moves.h).
enum class OrderKind : std::uint8_t {
  none,          // the order of the points is not kept
  row_major,     // rows as in the model's row_sequence, each once around by column, from the seam
  row_azimuth,   // the same by the points' own azimuth: where side offsets cross rays, not the same (KITTI)
  column_major,  // columns from first to last, in each the rows as in row_sequence, late by their row_delay
  row_column,    // as row_major, but by the column's azimuth alone: all rows begin at one firing
};

inline bool is_by_rows(OrderKind kind) {
  return kind != OrderKind::none && kind != OrderKind::column_major;
}

struct PointOrder {
  OrderKind kind = OrderKind::none;
  bool descending = false;      // towards smaller azimuths (column_major: from the last column to the first)
  std::uint32_t seam_tick = 0;  // rows: azimuth at which each begins, in ticks
  // After that, all points were sorted by a time that whole bursts of them share (burst_sort.h).
  bool in_bursts = false;
  friend bool operator==(const PointOrder&, const PointOrder&) = default;
};

struct SweepGrid {
  std::uint32_t ticks_per_turn = 0;  // the model's, or this sweep's own when the model has none
  // Strictly ascending. First in [0, ticks_per_turn), last less than two turns: sweeps in firing order may
  // cover more than a turn. Otherwise all are below ticks_per_turn.
  std::vector<std::uint32_t> column_tick;
  PointOrder order;
  std::optional<Twist> motion;  // present when the model is motion_compensated

  std::size_t column_count() const { return column_tick.size(); }
  friend bool operator==(const SweepGrid&, const SweepGrid&) = default;
};

enum class StrayReason : std::uint8_t {
  none,        // not a stray
  non_finite,  // a coordinate is NaN or infinite
  no_ray,      // at the axis, or so near that no ray points there
  off_row,     // no row passes near enough
  off_column,  // no column passes near enough
  collision,   // another point fits the same cell better
};

inline constexpr std::uint32_t kNoPoint = 0xffffffff;

struct GriddedSweep {
  SweepGrid grid;
  RawVector<std::int32_t> cell_of_point;     // row * column_count + column, or -1: stray
  RawVector<float> range_m;                  // along the ray from (0, 0, offset); 0 for strays
  RawVector<float> deviation_m;              // from the nearest point of the cell's ray; 0 for strays
  std::vector<StrayReason> stray_reason;     // per point
  std::vector<std::uint32_t> point_of_cell;  // the way back; kNoPoint: none
};

}  // namespace pointreel
