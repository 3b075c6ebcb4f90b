// Sensor model and sweep grid to bytes and back. The readers take any bytes: an Error or a value within
// limits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/result.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

std::vector<std::uint8_t> encode_sensor_model(const SensorModel& model);
Result<SensorModel> decode_sensor_model(std::span<const std::uint8_t> bytes);

std::vector<std::uint8_t> encode_sweep_grid(const SensorModel& model, const SweepGrid& grid);
Result<SweepGrid> decode_sweep_grid(const SensorModel& model, std::span<const std::uint8_t> bytes);

}  // namespace pointreel
