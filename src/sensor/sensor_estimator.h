// SensorEstimator: the sensor model from the sweeps themselves.
#pragma once

#include <optional>

#include "pointreel/point_cloud.h"
#include "sensor/projection.h"
#include "sensor/sensor_model.h"

namespace pointreel {

class SensorEstimator {
 public:
  explicit SensorEstimator(const GridOptions& options = {}) : options_(options) {}

  // The first usable sweep gives the model; sweeps after it change nothing.
  void add(const PointCloud& cloud);

  // None: no sweep so far comes from a sensor whose rows and columns can be told.
  const std::optional<SensorModel>& model() const { return model_; }

 private:
  GridOptions options_;
  std::optional<SensorModel> model_;
};

}  // namespace pointreel
