// The range image of a sweep as sections of its payload: from an earlier sweep where there is one, by itself
// where there is none.
//
//   warped reference (predicted frames) -> bands, in parallel
#pragma once

#include "base/bytes.h"
#include "base/parallel.h"
#include "motion/sweep_motion.h"
#include "planes/plane_tiles.h"
#include "pointreel/codec.h"
#include "predict/grid_image.h"
#include "predict/range_quantiser.h"
#include "predict/reference_sweep.h"
#include "predict/warp.h"

namespace pointreel {

// What both sides know of the sensor and the stream.
struct ImageSetting {
  const SensorModel& model;
  const SweepGrid& grid;
  const RangeQuantiser& quantiser;
  Effort effort;
  int threads;
  WarpMemory& warp_memory;               // of the stream
  std::span<const float> known_range_m;  // BandSetting::known_range_m
  BesideTasks beside;                    // run where the bands leave threads free
};

// The earlier sweep that a predicted frame starts from, and the motion since, as the stream has it.
struct Prediction {
  const ReferenceSweep& reference;
  const PlaneTiles& planes;  // of the reference; none without method `planes`
  SweepMotion motion;
};

// `prediction`: nullptr for a frame by itself. The ranges are replaced by what the decoder will see. Gives
// back what the bands have taught, empty for a frame by itself (ReferenceSweep::states).
std::vector<BandState> encode_image(const ImageSetting& setting, const Prediction* prediction,
                                    GridImage& image, ByteWriter& writer, FrameStatistics& statistics);

// Fills an empty image. Error: truncated or corrupt.
Result<std::vector<BandState>> decode_image(const ImageSetting& setting, const Prediction* prediction,
                                            ByteReader& reader, GridImage& image);

}  // namespace pointreel
