// The geometry of a sweep on its sensor's grid, as bytes: the core of method `mixture`.
//
//   cells:  planes -> code bands
//   points: order -> verify every point, correct those that miss -> strays
//
// No sweep needs another one's points: they are coded while the next sweep's cells are.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/image_sections.h"
#include "codec/plane_section.h"
#include "codec/sweep_cells.h"
#include "pointreel/codec.h"
#include "pointreel/point_cloud.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

// The points of a sweep in output order: those on its grid, between which strays stand.
struct OrderedPoints {
  std::vector<std::uint32_t> cells;   // of the sensor grid, of each point on it
  std::vector<std::uint32_t> strays;  // places in the output, ascending
};

// What the next sweep can be predicted from.
struct CodedImage {
  ReferenceSweep reference;
  PlaneTiles planes;  // of method `planes`
};

// What both sides know of the sensor and the stream; PointsSetting: what the points need of it.
struct GeometrySetting {
  const SensorModel& model;
  double max_error_m;
  Effort effort;
  int threads;
  PlaneStage planes;
  WarpMemory& warp_memory;  // of the stream
  BesideTasks beside;       // run where the bands leave threads free
};
struct PointsSetting {
  const SensorModel& model;
  double max_error_m;
  int threads;
};

GeometrySetting geometry_setting(const StreamHeader& header, const SensorModel& model, int threads,
                                 WarpMemory& warp_memory, BesideTasks beside = {});

// Those of a prediction, if there is one.
std::optional<EarlierPlanes> earlier_planes(const std::optional<Prediction>& prediction);

// The cells of a sweep, coded.
struct EncodedCells {
  std::vector<std::uint8_t> bytes;
  std::vector<float> range_of_cell_m;  // as decoded, by cell of the sensor grid; 0: no return
  CodedImage image;
};

// `sweep`: a projection; `cells`: its cells, whose image is used up. `prediction`: nullptr for a frame by
// itself; its pose is rounded for the stream.
EncodedCells encode_cells(const GeometrySetting& setting, const GriddedSweep& sweep, SweepCells& cells,
                          const Prediction* prediction, FrameStatistics& statistics);

struct EncodedPoints {
  OrderedPoints points;
  std::vector<std::uint32_t> output_order;  // index in the input of each output point; empty: the same
};

// All points of `cloud` must be finite. `bursts`: those of the sort that was undone, if one was
// (sensor/burst_sort.h). Appends the geometry to `writer`.
EncodedPoints encode_points(const PointsSetting& setting, const PointCloud& cloud, GriddedSweep sweep,
                            const SweepCells& sweep_cells, const EncodedCells& encoded_cells,
                            std::span<const std::uint32_t> bursts, ByteWriter& writer,
                            FrameStatistics& statistics);

struct DecodedCells {
  SweepGrid grid;
  CodingGrid coding;
  std::vector<float> range_of_cell_m;
};

// The points of decoded cells.
struct DecodedGeometry {
  OrderedPoints points;
  std::vector<Point3f> positions;
  bool order_kept = true;
  std::vector<std::uint32_t> bursts;  // sizes, where the output order has yet to be sorted by them
};

// `reference`: nullptr for a frame by itself. `image`: what the next sweep can be predicted from, on success;
// may be the reference. Error: truncated or corrupt.
Result<DecodedCells> decode_cells(const GeometrySetting& setting, const CodedImage* reference,
                                  ByteReader& reader, CodedImage& image);

// Error: truncated or corrupt; also when there are not `points_out` points.
Result<DecodedGeometry> decode_points(const PointsSetting& setting, std::size_t points_out,
                                      const DecodedCells& decoded_cells, ByteReader& reader);

// The planes of a sweep and the grid that they are on.
struct GriddedPlanes {
  SweepGrid grid;
  PlaneTiles tiles;
};

// Leaves the ranges where they are. Only for a setting with planes. Error: truncated or corrupt.
Result<GriddedPlanes> decode_gridded_planes(const GeometrySetting& setting, const GriddedPlanes* reference,
                                            ByteReader& reader);

}  // namespace pointreel
