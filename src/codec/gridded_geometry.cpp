#include "codec/gridded_geometry.h"

namespace pointreel {

GeometrySetting geometry_setting(const StreamHeader& header, const SensorModel& model, int threads,
                                 WarpMemory& warp_memory, BesideTasks beside) {
  const PlaneStage planes = header.method != Method::planes ? PlaneStage::none
                            : header.effort == Effort::fast ? PlaneStage::wherever_it_fits
                                                            : PlaneStage::where_it_pays;
  return {model, header.max_error_m, header.effort, threads, planes, warp_memory, beside};
}

std::optional<EarlierPlanes> earlier_planes(const std::optional<Prediction>& prediction) {
  if (!prediction) return std::nullopt;
  return EarlierPlanes{prediction->reference.grid, prediction->planes, prediction->motion.T_ref_cur};
}

}  // namespace pointreel
