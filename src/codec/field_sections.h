// The fields of a sweep in a payload: which ones, and their values in output order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/grid_points.h"
#include "pointreel/codec.h"

namespace pointreel {

inline constexpr std::size_t kMostFields = 256;  // of a sweep

// Called only where there are fields.
using FindPointCells = std::function<PointCells()>;

// Appends the chosen fields of `cloud`. `output_order`: index in `cloud` of each output point;
// empty: the same.
void encode_fields(const FieldSelection& selection, const PointCloud& cloud,
                   std::span<const std::uint32_t> output_order, const FindPointCells& find_cells, int threads,
                   ByteWriter& writer, FrameStatistics& statistics);

Result<std::vector<Field>> decode_fields(const FindPointCells& find_cells, int threads, ByteReader& reader);

}  // namespace pointreel
