// The one interface that every codec of the bench sits behind. One file each; each registers itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

using Bytes = std::vector<std::uint8_t>;

// One or more sweeps in bytes.
struct Chunk {
  Bytes bytes;
  std::size_t sweeps = 1;
};

// A stream of sweeps being encoded. Positions are finite; fields are not measured and may be ignored.
class SweepEncoder {
 public:
  virtual ~SweepEncoder() = default;
  // The chunks that are complete now: none while sweeps are waited for.
  virtual Result<std::vector<Chunk>> encode(const PointCloud& sweep) = 0;
  virtual Result<std::vector<Chunk>> finish() { return std::vector<Chunk>{}; }
  // Of the largest process that was run for it; 0: all happened in this one.
  virtual std::size_t program_peak_kib() const { return 0; }
};

// The chunks of one encoder in their order; the sweeps come back in theirs.
class SweepDecoder {
 public:
  virtual ~SweepDecoder() = default;
  virtual Result<std::vector<PointCloud>> decode(const Chunk& chunk) = 0;
  virtual Result<std::vector<PointCloud>> finish() { return std::vector<PointCloud>{}; }
  // All sweeps so far came with all their points, in the order of the input.
  virtual bool order_kept() const { return false; }
  virtual std::size_t program_peak_kib() const { return 0; }
};

// What is known of a drive before its first sweep is encoded.
struct DriveContext {
  std::span<const Pose> T_world_sensor;  // one a sweep, or none
  int threads = 1;                       // for codecs that can use more
};

// A codec at one setting.
class Codec {
 public:
  virtual ~Codec() = default;
  // The curve that this setting is a point of, such as "mixture balanced".
  virtual std::string series() const = 0;
  // What was set, in the codec's own words; unique within the series.
  virtual std::string settings() const = 0;
  virtual bool carries_fields() const { return false; }  // it could take intensity and the like as well
  virtual int threads(const DriveContext&) const { return 1; }

  virtual std::unique_ptr<SweepEncoder> encoder(const DriveContext& drive) const = 0;
  virtual std::unique_ptr<SweepDecoder> decoder(const DriveContext& drive) const = 0;
};

using Codecs = std::vector<std::unique_ptr<Codec>>;

// A codec at all settings worth a point in a plot. Error: why there are none here, such as a program that is
// not installed.
struct CodecFamily {
  std::string name;  // what --codecs calls it
  std::function<Result<Codecs>()> settings;
};

// All that were built, by name; then those that were not, whose settings() say what is missing.
std::vector<CodecFamily> codec_families();

struct CodecRegistration {
  CodecRegistration(std::string name, std::function<Result<Codecs>()> settings);
};

// A codec that takes every sweep by itself.
class SingleSweepCodec : public Codec {
 public:
  virtual bool keeps_order() const { return false; }
  virtual Result<Bytes> encode_sweep(const PointCloud& sweep) const = 0;
  virtual Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes) const = 0;
  std::unique_ptr<SweepEncoder> encoder(const DriveContext&) const override;
  std::unique_ptr<SweepDecoder> decoder(const DriveContext&) const override;
};

}  // namespace pointreel
