#include "codecs/range_imager.h"

#include <algorithm>

#include "base/bytes.h"
#include "entropy/adaptive_models.h"
#include "planes/occupancy_coding.h"
#include "planes/projection.h"
#include "sensor/projection.h"
#include "sensor/ray_table.h"
#include "sensor/sensor_coding.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {
namespace {

constexpr double kAzimuthStep_rad = 0.18 * kPi / 180;
constexpr double kElevationStep_rad = 0.45 * kPi / 180;
// Later sweeps may have a few columns, and rows to either side, more than the first.
constexpr int kSpareColumns = 64;
constexpr int kSpareRows = 4;

AngularGrid uniform_grid() {
  return *AngularGrid::create(kAzimuthStep_rad, kElevationStep_rad);
}

int rounded_up(int value, int multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

// Where a cell of the sensor grid is in the image: rows are turned so that what is above one another is
// seen in one direction.
std::vector<std::int32_t> image_columns(std::int32_t shift, std::size_t columns) {
  std::vector<std::int32_t> image_column(columns);
  const auto count = static_cast<std::int32_t>(columns);
  for (std::int32_t column = 0; column < count; ++column)
    image_column[static_cast<std::size_t>(column)] = (((column + shift) % count) + count) % count;
  return image_column;
}

void put_section(ByteWriter& writer, std::span<const std::uint8_t> bytes) {
  writer.put(static_cast<std::uint32_t>(bytes.size()));
  writer.put(bytes);
}

std::span<const std::uint8_t> get_section(ByteReader& reader) {
  return reader.get(reader.get<std::uint32_t>());
}

// By the coder that method `planes` has for its own image.
Bytes encode_mask(RangeImage& ranges) {
  BitEncoder coder;
  code_occupancy(coder, ranges, nullptr);
  return coder.finish();
}

void fill_gaps(const RangeImage& ranges, LevelImage& image) {
  std::uint16_t last = 0;
  for (std::size_t cell = 0; cell < image.level.size(); ++cell) {
    if (ranges.range_m[cell] > 0)
      last = image.level[cell];
    else
      image.level[cell] = last;
  }
}

}  // namespace

ImagerSettings imager_settings(ImageGrid grid, double max_error_m, std::uint16_t most) {
  // Half a step along the ray and the deviation across it: sqrt(0.95^2 + 0.3^2) = 0.996.
  return {grid, {2 * 0.95 * max_error_m, most}, 0.3 * max_error_m};
}

// Ranges by cell of the image, and the points that have none.
struct SweepImager::Cells {
  RangeImage ranges;
  std::vector<Point3f> beside;
};

SweepImager::SweepImager(const ImagerSettings& settings) : settings_(settings) {}

Result<SweepImager::Cells> SweepImager::sensor_cells(const PointCloud& sweep, Bytes& grid_bytes) {
  ByteWriter writer;
  GridOptions options;
  options.max_deviation_m = settings_.max_deviation_m;
  if (!model_) {
    SensorEstimator estimator(options);
    estimator.add(sweep);
    if (!estimator.model()) return Error{ErrorCode::unsupported, "no sensor grid found in the first sweep"};
    model_ = estimator.model();
    put_section(writer, encode_sensor_model(*model_));
  } else {
    put_section(writer, {});
  }
  const GriddedSweep gridded = project(*model_, sweep, options, previous_ ? &*previous_ : nullptr);
  const auto grid_columns = gridded.grid.column_count();
  put_section(writer, encode_sweep_grid(*model_, gridded.grid));
  grid_bytes = writer.take();
  const auto columns = static_cast<int>(grid_columns);
  if (columns_ == 0) {
    rows_ = static_cast<int>(model_->row_count());
    columns_ = rounded_up(columns + kSpareColumns, 16);
  }
  columns_ = std::max(columns_, rounded_up(columns, 16));

  Cells cells{{0, rows_, columns_, std::vector<float>(static_cast<std::size_t>(rows_) * columns_)}, {}};
  const auto shifts = column_shift_of_row(*model_, gridded.grid);
  std::vector<std::vector<std::int32_t>> image_column;
  image_column.reserve(shifts.size());
  for (const std::int32_t shift : shifts) image_column.push_back(image_columns(shift, grid_columns));
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const auto cell = static_cast<std::size_t>(gridded.cell_of_point[i]);
    const float range_m = gridded.range_m[i];
    if (gridded.cell_of_point[i] < 0 || !(range_m > 0) || settings_.scale.level_of(range_m) < 1 ||
        settings_.scale.level_of(range_m) > settings_.scale.most) {
      cells.beside.push_back(sweep.positions[i]);
      continue;
    }
    const std::size_t row = cell / grid_columns;
    cells.ranges.at(static_cast<int>(row), image_column[row][cell % grid_columns]) = range_m;
  }
  previous_ = gridded.grid;
  return cells;
}

Result<SweepImager::Cells> SweepImager::uniform_cells(const PointCloud& sweep, Bytes& grid_bytes) {
  const AngularGrid grid = uniform_grid();
  auto points = project_points(grid, sweep, Pose::Identity());
  Cells cells;
  if (columns_ == 0) {
    const auto band = range_image_of(grid, points, 1);
    if (!band) return band.error();
    first_row_ = std::max(0, band->first_row - kSpareRows);
    rows_ = rounded_up(band->rows + 2 * kSpareRows, 16);
    columns_ = grid.columns();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double level = settings_.scale.level_of(points[i].range_m);
    const int row = points[i].cell.row - first_row_;
    if (row >= 0 && row < rows_ && level >= 1 && level <= settings_.scale.most) continue;
    cells.beside.push_back(sweep.positions[i]);
    points[i].range_m = 0;
  }
  cells.ranges = {first_row_, rows_, columns_,
                  std::vector<float>(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_))};
  for (const ProjectedPoint& point : points) {
    if (!(point.range_m > 0)) continue;
    float& range_m = cells.ranges.at(point.cell.row - first_row_, point.cell.column);
    if (range_m == 0 || point.range_m < range_m) range_m = point.range_m;
  }
  ByteWriter writer;
  writer.put(static_cast<std::int32_t>(first_row_));
  grid_bytes = writer.take();
  return cells;
}

Result<ImagedSweep> SweepImager::image_of(const PointCloud& sweep) {
  Bytes grid_bytes;
  auto cells = settings_.grid == ImageGrid::sensor ? sensor_cells(sweep, grid_bytes)
                                                   : uniform_cells(sweep, grid_bytes);
  if (!cells) return cells.error();
  ImagedSweep imaged;
  imaged.image = {rows_, columns_, std::vector<std::uint16_t>(cells->ranges.range_m.size())};
  for (std::size_t cell = 0; cell < imaged.image.level.size(); ++cell) {
    imaged.image.level[cell] =
        static_cast<std::uint16_t>(settings_.scale.level_of(cells->ranges.range_m[cell]));
  }
  fill_gaps(cells->ranges, imaged.image);
  ByteWriter writer;
  writer.put(static_cast<std::uint16_t>(columns_));
  put_section(writer, grid_bytes);
  put_section(writer, encode_mask(cells->ranges));
  put_section(writer, {reinterpret_cast<const std::uint8_t*>(cells->beside.data()),
                       cells->beside.size() * sizeof(Point3f)});
  imaged.side = writer.take();
  return imaged;
}

Result<PointCloud> SweepImager::sweep_of(const LevelImage& image, std::span<const std::uint8_t> side) {
  ByteReader reader(side);
  const int columns = reader.get<std::uint16_t>();
  if (columns > image.columns) return Error{ErrorCode::corrupt, "the image is too narrow"};
  ByteReader grid_reader(get_section(reader));
  BitDecoder mask_coder(get_section(reader));
  const auto beside = get_section(reader);
  RangeImage ranges{
      0, image.rows, columns,
      std::vector<float>(static_cast<std::size_t>(image.rows) * static_cast<std::size_t>(columns))};
  code_occupancy(mask_coder, ranges, nullptr);
  for (int row = 0; row < ranges.rows; ++row) {
    const std::uint16_t* level =
        &image.level[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns)];
    for (int column = 0; column < columns; ++column) {
      if (ranges.occupied(row, column)) ranges.at(row, column) = settings_.scale.range_of(level[column]);
    }
  }

  PointCloud cloud;
  if (settings_.grid == ImageGrid::uniform) {
    ranges.first_row = grid_reader.get<std::int32_t>();
    cloud = cloud_of(uniform_grid(), ranges, Pose::Identity());
  } else {
    if (const auto model_bytes = get_section(grid_reader); !model_bytes.empty()) {
      auto model = decode_sensor_model(model_bytes);
      if (!model) return model.error();
      model_ = *std::move(model);
    }
    if (!model_) return Error{ErrorCode::corrupt, "no sensor model came before"};
    const auto grid = decode_sweep_grid(*model_, get_section(grid_reader));
    if (!grid) return grid.error();
    const RayTable rays(*model_, *grid);
    const auto shifts = column_shift_of_row(*model_, *grid);
    for (std::size_t row = 0; row < model_->row_count(); ++row) {
      const auto image_column = image_columns(shifts[row], grid->column_count());
      for (std::size_t column = 0; column < grid->column_count(); ++column) {
        const float range_m = ranges.at(static_cast<int>(row), image_column[column]);
        if (range_m > 0) cloud.positions.push_back(rays.position(row, column, range_m));
      }
    }
  }
  const std::size_t count = beside.size() / sizeof(Point3f);
  const std::size_t first = cloud.positions.size();
  cloud.positions.resize(first + count);
  if (count > 0) std::memcpy(&cloud.positions[first], beside.data(), count * sizeof(Point3f));
  return cloud;
}

}  // namespace pointreel
