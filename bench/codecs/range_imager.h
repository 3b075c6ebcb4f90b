// Sweeps as images of range levels for image and video codecs, and back.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codecs/codec.h"
#include "planes/angular_grid.h"
#include "sensor/sensor_model.h"
#include "sensor/sweep_grid.h"

namespace pointreel {

enum class ImageGrid : std::uint8_t {
  sensor,   // Pointreel's: the rows and columns of the sensor itself, each point in a cell of its own
  uniform,  // the paper's: 0.18 x 0.45 degrees, the nearest point of a cell stays
};

// Ranges as whole numbers.
struct LevelScale {
  double step_m = 0.02;
  std::uint16_t most = 65535;  // ranges beyond are no part of the image
  bool by_root = false;        // step_m * level^2 instead of step_m * level: for 8 bits

  double level_of(float range_m) const {
    return std::round(by_root ? std::sqrt(range_m / step_m) : range_m / step_m);
  }
  float range_of(std::uint16_t level) const {
    return static_cast<float>(step_m * level * (by_root ? level : 1));
  }
};

// How sweeps become images.
struct ImagerSettings {
  ImageGrid grid = ImageGrid::sensor;
  LevelScale scale;
  double max_deviation_m = 0.05;  // sensor grid: points farther from their ray go beside the image
};

// With levels that a codec keeps exactly, no point of the sensor grid is off by more than `max_error_m`.
ImagerSettings imager_settings(ImageGrid grid, double max_error_m, std::uint16_t most);

struct LevelImage {
  int rows = 0, columns = 0;
  std::vector<std::uint16_t> level;  // row-major
};

struct ImagedSweep {
  LevelImage image;  // cells without a return repeat their neighbour: nothing there for a codec to code
  Bytes side;        // grid, hit mask, points that are not in the image
};

// Images of the sensor grid may become wider than the first; their rows stay. Another SweepImager gets the
// sweeps back, from images that may have been made wider still.
class SweepImager {
 public:
  explicit SweepImager(const ImagerSettings& settings);
  Result<ImagedSweep> image_of(const PointCloud& sweep);
  Result<PointCloud> sweep_of(const LevelImage& image, std::span<const std::uint8_t> side);

 private:
  struct Cells;
  Result<Cells> sensor_cells(const PointCloud& sweep, Bytes& grid_bytes);
  Result<Cells> uniform_cells(const PointCloud& sweep, Bytes& grid_bytes);

  ImagerSettings settings_;
  int rows_ = 0, columns_ = 0, first_row_ = 0;  // of the images
  std::optional<SensorModel> model_;
  std::optional<SweepGrid> previous_;
};

}  // namespace pointreel
