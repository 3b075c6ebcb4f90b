#include "training_images.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

#include "codec/coding_grid.h"
#include "pointreel/io.h"
#include "require.h"
#include "sensor/sensor_estimator.h"

namespace pointreel {

std::vector<TrainingImage> training_images(const std::vector<std::string>& sweeps) {
  std::vector<TrainingImage> images;
  std::filesystem::path folder;
  std::optional<SensorEstimator> estimator;
  for (const auto& path : require(expand_inputs(sweeps))) {
    const PointCloud cloud = require(read_cloud(path));
    const bool follows = path.parent_path() == folder && estimator.has_value();
    if (!follows) estimator.emplace();
    folder = path.parent_path();
    estimator->add(cloud);
    if (!estimator->model()) {
      fmt::print(stderr, "{}: no sensor grid found\n", path.string());
      std::exit(1);
    }
    const GriddedSweep sweep = project(*estimator->model(), cloud);
    const CodingGrid grid(*estimator->model(), sweep.grid);
    TrainingImage image{grid.empty_image(), follows};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (sweep.cell_of_point[i] >= 0) {
        image.image.range_m[grid.image_index(static_cast<std::size_t>(sweep.cell_of_point[i]))] =
            sweep.range_m[i];
      }
    }
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace pointreel
