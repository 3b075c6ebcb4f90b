// Encoder and Decoder: sweeps to packets and back, one packet per sweep.
//
//   auto encoder = Encoder::create(options);
//   for (each sweep) for (const Packet& packet : *encoder->encode(cloud, T_world_sensor)) send(packet.bytes);
//   for (const Packet& packet : *encoder->finish()) send(packet.bytes);
//
// Files are written and read by ReelWriter and ReelReader (reel.h). Objects are independent; one object must
// not be used by two threads at once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pointreel/motion.h"
#include "pointreel/planes.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

enum class Method : std::uint8_t {
  planes = 1,   // after Feng, Liu, Zhu: Real-Time Spatio-Temporal LiDAR Point Cloud Compression, IROS 2020
  mixture = 2,  // every point within a bound: sensor-grid ranges coded by a mixture of predictors
};

// The range image that planes are found in.
enum class PlaneGrid : std::uint8_t {
  uniform = 0,  // the paper's: equal angles; of several points in a cell one is kept, at its centre
  sensor = 1,   // the sensor's own rays: every point is kept, within the bound of `mixture`
};

// How much work goes into a sweep on the sensor's grid: more work, fewer bits (docs/EFFORT.md). The decoder
// does the same.
enum class Effort : std::uint8_t { fast = 0, balanced = 1, max = 2 };

// How the ranges of cells that lie on no plane are kept (the paper's residual map).
enum class ResidualMode : std::uint8_t {
  stepped,   // quantised, predicted, entropy coded
  raw_float  // float32 as in the paper, entropy coded byte by byte
};

// Method `planes`. On the sensor's grid all else is MixtureOptions' matter: cells on planes need no coding,
// all others are coded by method `mixture`, every point within its bound. With effort `fast` cells are put on
// planes wherever they fit, otherwise where that saves bits.
//
// The other options are those of the uniform grid. There a sweep becomes a range image of equal angles; of
// several points in a cell the nearest is kept, at the cell's centre angles. Fields are not carried.
struct PlanesOptions {
  PlaneGrid grid = PlaneGrid::sensor;
  double threshold_m = 0.1;  // range error of a cell on a plane at most; 0.001 to 10
  double azimuth_step_rad = 0.18 * 3.14159265358979323846 / 180;    // 0.0003 to 0.1
  double elevation_step_rad = 0.45 * 3.14159265358979323846 / 180;  // 0.0003 to 0.1
  int tile_size = 4;                                                // cells a side, 2 to 16
  int group = 5;  // sweeps per group, 1 (every sweep by itself) to 255; the middle one is the key frame
  ResidualMode residual_mode = ResidualMode::stepped;
  double residual_step_m = 0;  // 0: twice the threshold, so that unfit cells keep the same range error
};

// A field of the input, by name, and how far its decoded values may be off.
struct FieldStep {
  std::string name;
  double step = 0;  // largest difference, in the field's own unit; 0: every value to the bit
};

// Which fields travel with the points.
struct FieldSelection {
  bool all_others = true;  // those not named: exactly, or not at all
  std::vector<FieldStep> named;

  const FieldStep* find(std::string_view name) const;  // nullptr when it is not named
};

// Method `mixture`, and `planes` on the sensor's grid. Every finite point comes back, within max_error_m of
// where it was; non-finite ones are dropped and counted. Clouds of rotating sensors are coded on the sensor's
// own grid, which is found from the sweeps; any other cloud by an octree.
struct MixtureOptions {
  double max_error_m =
      0.02;        // distance in space of each point to its own decoded float32 position; 0.0005 to 1
  int group = 10;  // sweeps per group, 1 to 255: the first decodes by itself and holds the sensor model
  Effort effort = Effort::balanced;
  bool temporal = true;  // sweeps are predicted from the one before, within their group
  // The motion since then is looked for in the sweeps; otherwise it is that of the poses given, or none.
  bool register_sweeps = true;
  FieldSelection fields;
};

// What the caller of an Encoder chooses.
struct EncoderOptions {
  Method method = Method::mixture;
  MixtureOptions mixture;
  PlanesOptions planes;
};

// What a decoder must know before the first packet.
struct StreamHeader {
  Method method = Method::mixture;
  double max_error_m = 0.02;         // on the sensor's grid only
  int group = 10;                    // on the sensor's grid only
  Effort effort = Effort::balanced;  // on the sensor's grid only
  PlanesOptions planes;              // `planes` only; uniform grid: with residual_step_m resolved

  // Method `mixture`, and `planes` unless its grid is uniform.
  bool on_sensor_grid() const;
  // On the sensor's grid: largest distance of a point to its own decoded position. On the uniform one:
  // largest range error of a kept point: the threshold, or half the residual step if that is more (decoded
  // positions are float32; where their rounding matters, 1 mm at 10 km, it comes on top).
  double bound_m() const;
};

// Settings that change no byte of any stream.
struct Runtime {
  int threads = 0;  // 0: one per processor
};

enum class FrameKind : std::uint8_t {
  key = 0,        // decodes by itself
  predicted = 1,  // needs its reference frame
};

// Where the bits of a packet and the cells of its range image went (encoder only, not in the stream).
struct FrameStatistics {
  double occupancy_bits = 0;  // which cells hold a point: both methods
  // on the sensor's grid
  double model_bits = 0;       // the sensor model
  double grid_bits = 0;        // columns, kind of order, motion
  double range_bits = 0;       // ranges of the points on the grid
  double order_bits = 0;       // points that stand elsewhere than the grid says
  double correction_bits = 0;  // of points too far from their ray
  double stray_bits = 0;       // points off the grid
  double scattered_bits = 0;   // the octree of a cloud without a grid
  double field_bits = 0;
  std::uint32_t corrected_points = 0;
  std::uint32_t stray_points = 0;
  // `planes`
  double plane_bits = 0;
  double residual_bits = 0;
  std::uint32_t spatial_cells = 0;   // on planes of this frame
  std::uint32_t temporal_cells = 0;  // on planes of the key frame with a new distance
  std::uint32_t unfit_cells = 0;     // in the residual map
  std::uint32_t runs = 0;
};

struct Packet {
  std::uint32_t frame = 0;  // number of the sweep, from 0
  std::uint32_t group = 0;
  std::uint32_t reference_frame = 0;  // = frame for a key frame
  FrameKind kind = FrameKind::key;
  std::uint32_t points_in = 0;   // points of the input sweep, all of them
  std::uint32_t points_out = 0;  // points that decoding gives back
  std::uint32_t non_finite = 0;  // input points with a NaN or infinite coordinate, which no method keeps
  std::vector<std::uint8_t> payload;
  FrameStatistics statistics;
};

// A packet as it is sent or stored: self-delimiting, with a checksum (docs/FORMAT.md).
std::vector<std::uint8_t> serialize(const Packet& packet);
std::vector<std::uint8_t> serialize(const StreamHeader& header);
// Exactly one packet. Errors: truncated, corrupt (message names the offset within `bytes`).
Result<Packet> parse_packet(std::span<const std::uint8_t> bytes);
Result<StreamHeader> parse_stream_header(std::span<const std::uint8_t> bytes);

// A sweep and its sensor's pose in any fixed frame, if that is known.
struct PosedSweep {
  PointCloud cloud;
  std::optional<Pose> T_world_sensor;
};

class Encoder {
 public:
  using Packets = Result<std::vector<Packet>>;

  // Error: invalid_argument naming the option.
  static Result<Encoder> create(const EncoderOptions& options, const Runtime& runtime = {});
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;
  ~Encoder();

  const StreamHeader& header() const;

  // Takes the next sweep. Returns the packets that are now complete: on the sensor's grid this sweep's, on
  // the uniform one none until a group is, then all of its packets, key frame first. The latter uses the
  // sweep's pose in any fixed frame (omit it for all sweeps when motion is unknown: they are then compared
  // where they stand); on the sensor's grid registration starts from it, or from the motion before. Errors:
  // resource_limit for a sweep of more than 2^23 points, invalid_argument for a field whose number of values
  // is not that of the points; the encoder then goes on without the sweep.
  Packets encode(PointCloud sweep, const std::optional<Pose>& T_world_sensor = {});
  // The same for sweeps that are there already, as in files: takes them from next() until it has none, and
  // hands each one's packets to take(), in order. finish() is still to be called. On the sensor's grid, with
  // two threads and more, three sweeps are worked on at once, which takes less time for all and changes no
  // byte; next() and take() then run on any thread and side by side, each once at a time. They must not
  // throw. When take() returns false, sweeps that next() has given are lost, and the encoder is done with.
  using NextSweep = std::function<std::optional<PosedSweep>()>;
  using TakePackets = std::function<bool(Packets)>;
  void encode_all(const NextSweep& next, const TakePackets& take);
  // Ends the stream: packets of the last, maybe shorter group.
  Packets finish();

  class Implementation;

 private:
  explicit Encoder(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

struct DecodedSweep {
  std::uint32_t frame = 0;
  PointCloud cloud;                      // the sweep's own sensor coordinates
  Pose T_key_sensor = Pose::Identity();  // uniform grid: the motion that was undone (predicted frames)
  bool order_kept = false;               // the points come in the order of the input
  bool temporal = false;                 // sensor's grid: predicted from the ranges of the sweep before
  std::uint64_t field_bytes = 0;         // of the packet's payload: what the fields took
};

class Decoder {
 public:
  static Result<Decoder> create(const StreamHeader& header, const Runtime& runtime = {});
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;
  ~Decoder();

  // Packets in stream order; groups of one call, and sweeps of effort fast, are decoded side by side. One
  // result per packet: a damaged packet, or one whose reference frame was not decoded, is an Error, and harms
  // only those that refer to it.
  std::vector<Result<DecodedSweep>> decode(std::span<const Packet> packets);

  // The planes alone, many times as fast: of method `planes` on the sensor's grid. Packets as for decode(),
  // which can go on from there at the next key frame. Sweeps without a grid have no planes. Error
  // unsupported: streams of another kind.
  std::vector<Result<SweepPlanes>> decode_planes(std::span<const Packet> packets);

  class Implementation;

 private:
  explicit Decoder(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

// Index into decoded.cloud of each original point's own decoded point; -1 for points that the method gave up
// (uniform grid: another point of the cell was nearer; not finite). `original` must be the sweep that was
// encoded. Where the order was not kept, points are matched one to one within the bound; those that cannot be
// get -1.
Result<std::vector<std::int64_t>> pair_points(const StreamHeader& header, const PointCloud& original,
                                              const DecodedSweep& decoded);

}  // namespace pointreel
