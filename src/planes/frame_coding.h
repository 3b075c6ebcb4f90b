// One range image to bytes and back: occupancy, plane runs, residual map.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planes/run_coding.h"
#include "planes/spatial.h"
#include "pointreel/codec.h"
#include "pointreel/result.h"

namespace pointreel {

struct FrameSettings {
  int tile_size = 4;
  PlaneTolerance tolerance;
  double residual_step_m = 0.2;  // 0: raw float32
};

// As `header` says; the quantisation step of planes follows from the threshold.
FrameSettings frame_settings(const PlanesOptions& options);

struct CodedFrame {
  std::vector<std::uint8_t> bytes;
  KeyFrame decoded;  // what the decoder will have
  FrameStatistics statistics;
};

// `key` is the decoded key frame for predicted frames, else nullptr. Bytes do not depend on `threads`.
CodedFrame encode_frame(const AngularGrid& grid, const RangeImage& image, const FrameSettings& settings,
                        const KeyFrame* key, int threads);

Result<KeyFrame> decode_frame(const AngularGrid& grid, std::span<const std::uint8_t> bytes,
                              const FrameSettings& settings, const KeyFrame* key);

}  // namespace pointreel
