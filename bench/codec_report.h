// What `pointreel bench` prints: a table to read, or a line of JSON for each codec and setting.
#pragma once

#include <string>
#include <vector>

#include "codec_measurement.h"

namespace pointreel {

// Peaks that papers give PSNR with: SemanticKITTI's, and MPEG's for its LiDAR sequences.
inline constexpr double kPeaks_m[] = {59.70, 30};

void print_codec_table(const std::vector<CodecMeasurement>& measurements, const BenchSettings& settings);
// One object, without a line break.
std::string to_json_line(const CodecMeasurement& measurement, const BenchSettings& settings);

}  // namespace pointreel
