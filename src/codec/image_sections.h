// The range image of a sweep as sections of its payload: from an earlier sweep where there is one, by itself
// where there is none.
//
//   pose of the sweep in the reference (predicted frames) -> warped reference -> bands, in parallel
#pragma once

#include "base/bytes.h"
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
  WarpMemory& warp_memory;  // of the stream
};

// The earlier sweep that a predicted frame starts from, and the motion since.
struct Prediction {
  const ReferenceSweep& reference;
  Pose T_ref_cur = Pose::Identity();  // the encoder's: it is rounded for the stream
};

// `prediction`: nullptr for a frame by itself. The ranges are replaced by what the decoder will see. Gives
// back what the bands have taught, empty for a frame by itself (ReferenceSweep::states).
std::vector<BandState> encode_image(const ImageSetting& setting, const Prediction* prediction,
                                    GridImage& image, ByteWriter& writer, FrameStatistics& statistics);

// `reference`: nullptr for a frame by itself. Fills an empty image. Error: truncated or corrupt.
Result<std::vector<BandState>> decode_image(const ImageSetting& setting, const ReferenceSweep* reference,
                                            ByteReader& reader, GridImage& image);

}  // namespace pointreel
