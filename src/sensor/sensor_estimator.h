// SensorEstimator: the sensor model from the sweeps themselves.
#pragma once

#include <optional>

#include "pointreel/point_cloud.h"
#include "sensor/projection.h"
#include "sensor/range_lattice.h"
#include "sensor/row_refinement.h"
#include "sensor/sensor_model.h"

namespace pointreel {

class SensorEstimator {
 public:
  explicit SensorEstimator(const GridOptions& options = {}) : options_(options) {}

  // The first usable sweep gives the model, a few more refine its rows: ticks, rings and the sequence of the
  // rows stay. `projected`: this sweep on the grid of a model given before, if at hand; it saves most of the
  // time.
  void add(const PointCloud& cloud, const GriddedSweep* projected = nullptr);

  // None: no sweep so far comes from a sensor whose rows and columns can be told.
  const std::optional<SensorModel>& model() const { return model_; }

 private:
  bool accept(SensorModel model, const PointCloud& cloud);
  void refine(const PointCloud& cloud, const GriddedSweep& sweep, bool rows);

  GridOptions options_;
  std::optional<SensorModel> model_;
  std::optional<RowRefinement> refinement_;
  RangeLattice lattice_;
  int sweeps_ = 0;  // in the model
};

}  // namespace pointreel
