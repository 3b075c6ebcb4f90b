#include "sensor/sensor_coding.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/trigonometry.h"
#include "entropy/adaptive_models.h"
#include "entropy/plain_bits.h"

namespace pointreel {
namespace {

template <class Coder>
std::uint32_t code_bits(Coder& coder, std::uint32_t value, int bits) {
  return static_cast<std::uint32_t>(code_plain_bits(coder, value, bits));
}

// Signed integers whose size varies slowly: number of bits by adaptive binary decisions, then the bits.
class SizedInteger {
 public:
  template <class Coder>
  std::int32_t code(Coder& coder, std::int32_t value) {
    const std::uint32_t magnitude = static_cast<std::uint32_t>(std::abs(static_cast<std::int64_t>(value)));
    std::uint32_t bits = 0;
    while (bits < kMostBits && (magnitude >> bits) != 0) ++bits;
    std::uint32_t node = 1;
    for (int level = 4; level >= 0; --level)
      node = (node << 1) | (coder.code(size_[node], (bits >> level) & 1u) ? 1u : 0u);
    bits = node & 31u;
    if (bits == 0) return 0;
    if (bits > kMostBits) bits = kMostBits;
    const std::uint32_t rest = code_bits(coder, magnitude, static_cast<int>(bits) - 1);
    const auto size = static_cast<std::int32_t>((1u << (bits - 1)) | (rest & ((1u << (bits - 1)) - 1)));
    return coder.code(negative_, value < 0) ? -size : size;
  }

 private:
  static constexpr std::uint32_t kMostBits = 30;
  std::array<AdaptiveBit, 32> size_;
  AdaptiveBit negative_;
};

std::int32_t in_steps(double value, double step) {
  constexpr double kMost = 1 << 29;
  const double steps = std::nearbyint(value / step);
  return static_cast<std::int32_t>(steps > kMost ? kMost : steps < -kMost ? -kMost : steps);
}

struct ModelModels {
  SizedInteger slope, offset, azimuth, side, sequence, delay, ring, phase;
};

// One field of all rows. `row(r)` is a reference to it; the value two rows up predicts where lasers
// alternate.
template <class Coder, class Access>
void code_column(Coder& coder, SizedInteger& model, std::size_t rows, std::size_t lag, double step,
                 const Access& access) {
  std::vector<std::int32_t> steps(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const std::int32_t predicted = r >= lag ? steps[r - lag] : 0;
    const auto difference = static_cast<std::int64_t>(in_steps(access(r), step)) - predicted;
    const std::int64_t coded =
        predicted + static_cast<std::int64_t>(model.code(coder, static_cast<std::int32_t>(difference)));
    steps[r] = static_cast<std::int32_t>(coded > (1 << 29)    ? (1 << 29)
                                         : coded < -(1 << 29) ? -(1 << 29)
                                                              : coded);
    access(r) = steps[r] * step;
  }
}

constexpr int kVersionBits = 3;

// Encoder and decoder alike; the decoder passes an empty model. False: not a model.
template <class Coder>
bool code_model(Coder& coder, SensorModel& model) {
  if (code_bits(coder, 0, kVersionBits) != 0) return false;
  const std::size_t rows = code_bits(coder, static_cast<std::uint32_t>(model.rows.size()), 10);
  if (rows > kMaxRows) return false;
  model.rows.resize(rows);
  model.row_sequence.resize(rows);
  model.ticks_per_turn = code_bits(coder, model.ticks_per_turn, 23);
  if (model.ticks_per_turn > kMaxTicksPerTurn) return false;
  model.motion_compensated = code_bits(coder, model.motion_compensated ? 1 : 0, 1) != 0;
  const bool has_rings = code_bits(coder, model.ring_of_row.empty() ? 0 : 1, 1) != 0;
  const bool has_delays = code_bits(coder, model.row_delay.empty() ? 0 : 1, 1) != 0;
  const std::uint32_t range_step_um =
      code_bits(coder, static_cast<std::uint32_t>(in_steps(model.range_step_m, 1e-6)), 16);
  model.range_step_m = range_step_um * 1e-6;
  if (has_rings) model.ring_of_row.resize(rows);
  if (has_delays) model.row_delay.resize(rows);
  if (range_step_um != 0) model.range_phase.resize(rows);

  ModelModels models;
  code_column(coder, models.slope, rows, 1, kSlopeStep,
              [&](std::size_t r) -> double& { return model.rows[r].slope; });
  code_column(coder, models.offset, rows, 1, kOffsetStepM,
              [&](std::size_t r) -> double& { return model.rows[r].offset_m; });
  code_column(coder, models.side, rows, 2, kOffsetStepM,
              [&](std::size_t r) -> double& { return model.rows[r].side_offset_m; });
  std::int32_t turn = 0;
  for (RowModel& row : model.rows) {
    turn += models.azimuth.code(coder, in_steps(row.azimuth_rad / kTurn, kAzimuthStepTurns) - turn);
    if (turn < -(1 << 22) || turn > (1 << 22)) return false;
    row.azimuth_rad = turn * kAzimuthStepTurns * kTurn;
  }
  std::int32_t place = -1;
  std::vector<std::uint8_t> seen(rows, 0);
  for (std::uint16_t& row : model.row_sequence) {
    place += 1 + models.sequence.code(coder, row - place - 1);
    if (place < 0 || static_cast<std::size_t>(place) >= rows || seen[static_cast<std::size_t>(place)] != 0)
      return false;
    seen[static_cast<std::size_t>(place)] = 1;
    row = static_cast<std::uint16_t>(place);
  }
  std::int32_t delay = 0;
  for (std::uint16_t& columns : model.row_delay) {
    delay += models.delay.code(coder, columns - delay);
    if (delay < 0 || delay > static_cast<std::int32_t>(kMaxRowDelay)) return false;
    columns = static_cast<std::uint16_t>(delay);
  }
  std::int64_t ring = 0;
  for (std::int32_t& value : model.ring_of_row) {
    ring += models.ring.code(coder, static_cast<std::int32_t>(value - ring));
    if (std::llabs(ring) > (1 << 30)) return false;
    value = static_cast<std::int32_t>(ring);
  }
  for (double& phase : model.range_phase) {
    const auto steps = code_bits(
        coder, static_cast<std::uint32_t>(in_steps(phase, 1.0 / kRangePhaseSteps)) % kRangePhaseSteps, 6);
    phase = static_cast<double>(steps) / kRangePhaseSteps;
  }
  return true;
}

// Follows the rotation: where the next column will be, in 1/65536 tick. A second-order loop, since the sensor
// turns nearly steadily and the encoder only rounds it to ticks.
class TickLoop {
 public:
  static constexpr int kFraction = 16;
  TickLoop(std::int64_t first_tick, std::int64_t step) : place_(first_tick << kFraction), step_(step) {}

  std::int64_t predicted() const { return place_ + step_; }
  void update(std::int64_t tick) {
    place_ += step_;
    const std::int64_t error = (tick << kFraction) - place_;
    const std::int64_t most = 2 * (step_ > (1 << kFraction) ? step_ : (1 << kFraction));
    if (error > most || error < -most) {
      place_ = tick << kFraction;  // a gap without returns: start again behind it
      return;
    }
    place_ += error / 8;
    step_ += error / 256;
    if (step_ < (1 << kFraction)) step_ = 1 << kFraction;
  }

 private:
  std::int64_t place_, step_;
};

constexpr std::size_t kPhases = 16;

template <class Coder>
bool code_ticks(Coder& coder, std::uint32_t turn, std::vector<std::uint32_t>& ticks) {
  if (ticks.empty()) return true;
  const std::size_t count = ticks.size();
  ticks[0] = code_bits(coder, ticks[0], 23);
  if (ticks[0] >= turn) return false;
  if (count == 1) return true;
  // Mean step in 1/256 tick.
  const std::uint64_t span = ticks.back() > ticks.front() ? ticks.back() - ticks.front() : 0;
  const auto mean = static_cast<std::uint32_t>((span << 8) / (count - 1));
  const std::int64_t step = code_bits(coder, mean, 31);
  TickLoop loop(ticks[0], step << (TickLoop::kFraction - 8));
  std::array<AdaptiveInteger, kPhases> models;
  std::int64_t last = ticks[0];
  for (std::size_t c = 1; c < count; ++c) {
    std::int64_t predicted = loop.predicted();
    if (predicted < (last + 1) << TickLoop::kFraction) predicted = (last + 1) << TickLoop::kFraction;
    const std::int64_t whole = predicted >> TickLoop::kFraction;
    const auto phase = static_cast<std::size_t>((predicted >> (TickLoop::kFraction - 4)) & (kPhases - 1));
    const std::int64_t tick = whole + models[phase].code(coder, static_cast<std::int32_t>(ticks[c] - whole));
    if (tick <= last || tick >= 2 * static_cast<std::int64_t>(turn)) return false;
    ticks[c] = static_cast<std::uint32_t>(tick);
    loop.update(tick);
    last = tick;
  }
  return true;
}

template <class Coder>
bool code_grid(Coder& coder, const SensorModel& model, SweepGrid& grid) {
  const std::size_t columns = code_bits(coder, static_cast<std::uint32_t>(grid.column_count()), 17);
  if (columns > kMaxColumns || columns * model.rows.size() > kMaxCells) return false;
  grid.ticks_per_turn =
      model.ticks_per_turn != 0 ? model.ticks_per_turn : code_bits(coder, grid.ticks_per_turn, 23);
  if (grid.ticks_per_turn == 0 || grid.ticks_per_turn > kMaxTicksPerTurn) return false;
  grid.column_tick.resize(columns);
  if (!code_ticks(coder, grid.ticks_per_turn, grid.column_tick)) return false;
  const std::uint32_t kind = code_bits(coder, static_cast<std::uint32_t>(grid.order.kind), 3);
  if (kind > static_cast<std::uint32_t>(OrderKind::row_column)) return false;
  grid.order.kind = static_cast<OrderKind>(kind);
  grid.order.descending = code_bits(coder, grid.order.descending ? 1 : 0, 1) != 0;
  grid.order.in_bursts = code_bits(coder, grid.order.in_bursts ? 1 : 0, 1) != 0;
  if (is_by_rows(grid.order.kind)) {
    const bool seam = code_bits(coder, grid.order.seam_tick != 0 ? 1 : 0, 1) != 0;
    if (seam) grid.order.seam_tick = code_bits(coder, grid.order.seam_tick, 23);
    if (grid.order.seam_tick >= grid.ticks_per_turn) return false;
  }
  if (!model.motion_compensated) return true;
  if (!grid.motion) grid.motion.emplace();
  SizedInteger component;
  for (auto* values : {&grid.motion->v_m, &grid.motion->w_rad}) {
    for (double& value : *values) {
      value = component.code(coder, in_steps(value, kTwistStep)) * kTwistStep;
      if (!(value >= -kMaxTwist && value <= kMaxTwist)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode_sensor_model(const SensorModel& model) {
  BitEncoder coder;
  SensorModel coded = model;
  code_model(coder, coded);
  return coder.finish();
}

Result<SensorModel> decode_sensor_model(std::span<const std::uint8_t> bytes) {
  BitDecoder coder(bytes);
  SensorModel model;
  if (!code_model(coder, model)) return Error{ErrorCode::corrupt, "the sensor model contradicts itself"};
  if (coder.overran()) return Error{ErrorCode::truncated, "the sensor model ends early"};
  return model;
}

std::vector<std::uint8_t> encode_sweep_grid(const SensorModel& model, const SweepGrid& grid) {
  BitEncoder coder;
  SweepGrid coded = grid;
  code_grid(coder, model, coded);
  return coder.finish();
}

Result<SweepGrid> decode_sweep_grid(const SensorModel& model, std::span<const std::uint8_t> bytes) {
  BitDecoder coder(bytes);
  SweepGrid grid;
  if (!code_grid(coder, model, grid)) return Error{ErrorCode::corrupt, "the sweep's grid contradicts itself"};
  if (coder.overran()) return Error{ErrorCode::truncated, "the sweep's grid ends early"};
  return grid;
}

}  // namespace pointreel
