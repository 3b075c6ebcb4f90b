// SensorModel: where each laser of a spinning sensor sits and points. Found once per stream and kept in it.
//
// A point of row k in column c, at range r along its ray, with rho = r / sqrt(1 + slope^2):
//   z = slope * rho + offset,  azimuth = column azimuth + alpha + atan2(h, rho),  hypot(x, y) = rho.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointreel {

// One laser. The values are multiples of the steps below, so that encoder and decoder hold the same numbers.
struct RowModel {
  double slope = 0;          // dz / drho
  double offset_m = 0;       // z where rho is 0
  double azimuth_rad = 0;    // alpha, in (-pi, pi]: azimuth of the row at column azimuth 0
  double side_offset_m = 0;  // h: how far to the left of the axis the laser sits
  friend bool operator==(const RowModel&, const RowModel&) = default;
};

struct SensorModel {
  std::vector<RowModel> rows;  // top to bottom, by the elevation far away
  // Columns sit on whole ticks of the encoder (4000 per turn for KITTI); 0: on no lattice, so that each sweep
  // chooses how finely it sends the azimuths of its columns.
  std::uint32_t ticks_per_turn = 0;
  // The sweeps were motion-compensated by KITTI's rule; each brings its own Twist.
  bool motion_compensated = false;
  // Rows in the order in which the points of one column (column-major clouds) or of the whole sweep
  // (row-major clouds) come. A permutation of 0 .. rows - 1.
  std::vector<std::uint16_t> row_sequence;
  // Column-major clouds: by how many columns each row's points come late, 0 to kMaxRowDelay; empty: by none.
  std::vector<std::uint16_t> row_delay;
  // What the input's ring field says for each row; empty when there was none.
  std::vector<std::int32_t> ring_of_row;
  // The sensor measures range along the ray as (n + phase) * step; step 0 when no lattice was found.
  double range_step_m = 0;
  std::vector<double> range_phase;  // per row, in [0, 1); empty without a lattice

  std::size_t row_count() const { return rows.size(); }
  friend bool operator==(const SensorModel&, const SensorModel&) = default;
};

inline constexpr std::size_t kMaxRows = 512;
inline constexpr std::size_t kMaxColumns = 65536;
inline constexpr std::size_t kMaxCells = std::size_t{1} << 24;
inline constexpr std::uint32_t kMaxTicksPerTurn = 1u << 22;
inline constexpr std::uint32_t kMaxRowDelay = 1023;

// Half a step moves a point by at most 0.06 mm, 80 m away.
inline constexpr double kSlopeStep = 1.0 / (1 << 20);
inline constexpr double kOffsetStepM = 1.0 / (1 << 13);  // of both offsets
inline constexpr double kAzimuthStepTurns = 1.0 / (1 << 22);
inline constexpr std::uint32_t kRangePhaseSteps = 64;  // per step of the range lattice

// The nearest model that the stream can carry; `row` may hold any finite values.
RowModel rounded(const RowModel& row);

}  // namespace pointreel
