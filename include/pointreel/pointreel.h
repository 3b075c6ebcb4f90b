// The whole library in two calls: sweeps to bytes and back.
//
//   auto bytes = pointreel::encode(sweeps, options);   // a whole .reel, to send or to write to a file
//   auto decoded = pointreel::decode(*bytes);          // one DecodedSweep for each sweep, in their order
//
// Everything is in memory at once. For a stream as it comes, Encoder and Decoder take it sweep by sweep
// (codec.h); ReelWriter and ReelReader do so with files, and find single frames in them (reel.h).
//
// Both functions may be called from any number of threads at once; each uses up to runtime.threads of its own
// while it runs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pointreel/codec.h"
#include "pointreel/motion.h"
#include "pointreel/point_cloud.h"
#include "pointreel/reel.h"
#include "pointreel/result.h"

namespace pointreel {

// Sweeps in the order they were measured, positions in metres in the sensor's own coordinates, every field
// with one value per point. The result holds all their points within options.mixture.max_error_m, or what
// Encoder says of method `planes`. T_world_sensor is empty or has one pose for each sweep (`planes` needs
// them for its groups, `mixture` starts its own registration from them). Equal arguments give equal bytes,
// whatever the number of threads. Errors: invalid_argument for an option out of its range, another number of
// poses than sweeps, or a field whose number of values is not that of the points; resource_limit for a sweep
// of more than 2^23 points.
Result<std::vector<std::uint8_t>> encode(std::span<const PointCloud> sweeps,
                                         const EncoderOptions& options = {},
                                         std::span<const Pose> T_world_sensor = {},
                                         const Runtime& runtime = {});

// All sweeps of a whole .reel, by frame number. Errors: corrupt or truncated with the offset or the frame at
// fault, unsupported for a later version of the format, resource_limit. A damaged reel is an error as a
// whole: ReelReader gives what is still good.
Result<std::vector<DecodedSweep>> decode(std::span<const std::uint8_t> reel, const Runtime& runtime = {});

}  // namespace pointreel
