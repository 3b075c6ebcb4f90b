// SensorEstimator: the sensor model from the sweeps themselves.
#pragma once

#include <cstddef>
#include <optional>

#include "pointreel/point_cloud.h"
#include "sensor/projection.h"
#include "sensor/range_lattice.h"
#include "sensor/row_refinement.h"
#include "sensor/row_samples.h"
#include "sensor/sensor_model.h"

namespace pointreel {

class SensorEstimator {
 public:
  // `turns`: each of that many sweeps refines another part of the rows, which spreads the work.
  explicit SensorEstimator(const GridOptions& options = {}, std::size_t turns = 1)
      : options_(options), turns_(turns) {}

  // The first usable sweep gives the model, seven more per turn refine its rows: ticks, rings and the
  // sequence of the rows stay.
  void add(const PointCloud& cloud);
  // The same for a sweep that is projected already, with a model given before.
  void refine(const PointCloud& cloud, const GriddedSweep& sweep);

  // None: no sweep so far comes from a sensor whose rows and columns can be told.
  const std::optional<SensorModel>& model() const { return model_; }

 private:
  static constexpr std::size_t kRefiningSweeps = 7;  // per turn

  bool is_settled() const { return refined_ == kRefiningSweeps * turns_; }
  bool accept(SensorModel model, const PointCloud& cloud);
  void take_in(const PointCloud& cloud, const GriddedSweep& sweep, const RowsInTurn& turn);

  GridOptions options_;
  std::size_t turns_;
  std::optional<SensorModel> model_;
  std::optional<RowRefinement> refinement_;
  RangeLattice lattice_;
  std::size_t refined_ = 0;  // sweeps, but for the first
};

}  // namespace pointreel
