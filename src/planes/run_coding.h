// The plane runs of a frame: which tiles they cover, and their planes, predicted from planes already known.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_models.h"
#include "planes/plane_run.h"
#include "planes/run_anchors.h"
#include "planes/temporal.h"
#include "planes/tile_cells.h"

namespace pointreel {

// The key frame as predicted frames see it.
struct KeyFrame {
  RangeImage image;  // decoded
  PlaneMap planes;

  // Its runs (or negative marks) at the tiles of a row of another image on the same grid; nullptr where it
  // has no such row.
  const std::int32_t* runs_of_tile_row(const RangeImage& other, int tile_row) const {
    const TileLayout& layout = planes.layout;
    const int own_row = tile_row + (other.first_row - image.first_row) / layout.tile_size;
    if (own_row < 0 || own_row >= layout.tile_rows) return nullptr;
    return &planes.run_of_tile[layout.index(own_row, 0)];
  }
};

// Codes a PlaneMap over a known occupancy. A decoder passes a map with layout and an empty run list;
// run_of_tile must be sized and all kUnfitTile.
template <class Coder>
class RunCoder {
 public:
  RunCoder(Coder& coder, const AngularGrid& grid, double plane_step_m, const KeyFrame* key)
      : coder_(coder), grid_(grid), plane_step_m_(plane_step_m), key_(key) {}

  // False when the bytes cannot be a plane map (decoding only).
  bool code(const RangeImage& occupancy, PlaneMap& map) {
    const PlaneMap source = Coder::kDecodes ? PlaneMap{} : map;
    if constexpr (!Coder::kDecodes) {
      map.runs.clear();
      std::fill(map.run_of_tile.begin(), map.run_of_tile.end(), kUnfitTile);
    }
    for (int tile_row = 0; tile_row < map.layout.tile_rows; ++tile_row) {
      const std::size_t first_run = map.runs.size();
      code_tile_row_labels(occupancy, source, map, tile_row);
      for (std::size_t r = first_run; r < map.runs.size(); ++r) {
        if (!Coder::kDecodes) map.runs[r].levels = source.runs[r].levels;
        if (!code_plane(occupancy, map, map.runs[r])) return false;
        for (int t = map.runs[r].first_tile; t < map.runs[r].end_tile; ++t) {
          map.run_of_tile[map.layout.index(tile_row, t)] = static_cast<std::int32_t>(r);
        }
      }
    }
    return true;
  }

 private:
  // Run of the key frame at a tile of this frame, or a negative mark.
  std::int32_t key_run_at(const RangeImage& occupancy, int tile_row, int tile) const {
    const std::int32_t* runs = key_ != nullptr ? key_->runs_of_tile_row(occupancy, tile_row) : nullptr;
    return runs != nullptr ? runs[tile] : kUnfitTile;
  }

  // Adds the runs of one row to map.runs (tiles and kind, no planes yet).
  void code_tile_row_labels(const RangeImage& occupancy, const PlaneMap& source, PlaneMap& map,
                            int tile_row) {
    enum : unsigned { kNone = 0, kUnfit = 1, kSpatial = 2, kTemporal = 3 };
    const TileLayout& layout = map.layout;
    unsigned previous = kNone;
    bool open = false;  // the last of map.runs may continue
    for (int tile = 0; tile < layout.tile_columns; ++tile) {
      if (!tile_occupied(occupancy, layout, tile_row, tile)) continue;
      const std::int32_t wanted =
          Coder::kDecodes ? kUnfitTile : source.run_of_tile[layout.index(tile_row, tile)];
      const PlaneRun* wanted_run = wanted >= 0 ? &source.runs[static_cast<std::size_t>(wanted)] : nullptr;
      const std::int32_t key_run = key_run_at(occupancy, tile_row, tile);

      // Above: 0 nothing or unfit, 1 inside a run, 2 a run starts there (borders of surfaces go on
      // downwards).
      unsigned above = 0;
      if (tile_row > 0) {
        const std::int32_t run_above = map.run_of_tile[layout.index(tile_row - 1, tile)];
        if (run_above >= 0) above = map.runs[static_cast<std::size_t>(run_above)].first_tile == tile ? 2 : 1;
      }
      if (open) {
        PlaneRun& run = map.runs.back();
        const bool may_continue = run.kind == RunKind::spatial || run.key_run == key_run;
        if (may_continue) {
          const unsigned length = std::min(3u, static_cast<unsigned>(run.end_tile - run.first_tile) / 2u);
          const unsigned key_ends = key_run == last_key_run_ ? 0u : 1u;
          AdaptiveBit& model = continue_[previous][above][length][key_ends];
          if (coder_.code(model, wanted_run != nullptr && wanted_run->first_tile == run.first_tile)) {
            run.end_tile = tile + 1;
            last_key_run_ = key_run;
            continue;
          }
        }
      }
      last_key_run_ = key_run;
      const unsigned has_key = key_run >= 0 ? 1u : 0u;
      open = coder_.code(plane_[previous][above][has_key], wanted_run != nullptr);
      previous = kUnfit;
      if (!open) continue;
      PlaneRun run;
      run.tile_row = tile_row;
      run.first_tile = tile;
      run.end_tile = tile + 1;
      if (has_key != 0 && coder_.code(temporal_[previous][above],
                                      wanted_run != nullptr && wanted_run->kind == RunKind::temporal)) {
        run.kind = RunKind::temporal;
        run.key_run = key_run;
      }
      previous = run.kind == RunKind::spatial ? kSpatial : kTemporal;
      map.runs.push_back(run);
    }
  }

  bool code_plane(const RangeImage& occupancy, const PlaneMap& map, PlaneRun& run) {
    if (run.kind == RunKind::temporal) {
      const Plane& key_plane = key_->planes.runs[static_cast<std::size_t>(run.key_run)].plane;
      const float farthest_m = farthest_on_plane(grid_, occupancy, map.layout, run, key_plane);
      if (!(farthest_m > 0)) return false;
      run.levels[0] = shift_.code(coder_, run.levels[0]);
      run.plane = shifted_plane(key_plane, run.levels[0], farthest_m, plane_step_m_);
      return true;
    }
    const RunAnchors anchors = choose_anchors(occupancy, map.layout, run);
    gather_candidates(occupancy, map, run);
    for (int i = 0; i < anchors.count; ++i) {
      int quality = 0;
      const std::int32_t predicted = predict_level(anchors, run.levels, i, quality);
      const std::int32_t residual = level_[i][quality].code(coder_, run.levels[i] - predicted);
      run.levels[i] = static_cast<std::int32_t>(
          std::clamp<std::int64_t>(std::int64_t{predicted} + residual, 1, kMaxLevel));
    }
    last_level_ = run.levels[0];
    run.plane = plane_from_anchors(grid_, anchors, run.levels, plane_step_m_);
    return true;
  }

  // Planes that may go on in this run: the key frame's, the one to the left, those above its two ends.
  void gather_candidates(const RangeImage& occupancy, const PlaneMap& map, const PlaneRun& run) {
    candidates_.clear();
    const auto add = [&](const PlaneMap& from, std::int32_t index) {
      if (index >= 0) candidates_.push_back(from.runs[static_cast<std::size_t>(index)].plane);
    };
    if (key_ != nullptr) add(key_->planes, key_run_at(occupancy, run.tile_row, run.first_tile));
    if (run.first_tile > 0) add(map, map.run_of_tile[map.layout.index(run.tile_row, run.first_tile - 1)]);
    if (run.tile_row > 0) {
      add(map, map.run_of_tile[map.layout.index(run.tile_row - 1, run.first_tile)]);
      add(map, map.run_of_tile[map.layout.index(run.tile_row - 1, run.end_tile - 1)]);
    }
  }

  // The first anchor from the first candidate; the others from the candidate that came closest to the anchors
  // known so far, moved parallel through the first; from a constant range where none came close.
  std::int32_t predict_level(const RunAnchors& anchors, const std::array<std::int32_t, 3>& levels, int anchor,
                             int& quality) const {
    if (anchor == 0) {
      for (const Plane& plane : candidates_) {
        const double range = plane_range(grid_, plane, anchors.cells[0].row, anchors.cells[0].column);
        if (range > 0 && range < kFarthestPrediction_m) {
          quality = 0;
          return nearest_level(range, plane_step_m_);
        }
      }
      quality = 1;
      return last_level_;
    }
    double best_miss = 1e30;
    std::int32_t predicted = levels[0];
    for (const Plane& plane : candidates_) {
      const double at_first = plane_range(grid_, plane, anchors.cells[0].row, anchors.cells[0].column);
      const double here = plane_range(grid_, plane, anchors.cells[anchor].row, anchors.cells[anchor].column);
      if (!(at_first > 0 && at_first < kFarthestPrediction_m && here > 0 && here < kFarthestPrediction_m))
        continue;
      const double scale = levels[0] * plane_step_m_ / at_first;
      double miss = std::fabs(scale - 1) * at_first;
      if (anchor == 2) {
        const double second = plane_range(grid_, plane, anchors.cells[1].row, anchors.cells[1].column);
        miss += std::fabs(second * scale - levels[1] * plane_step_m_);
      }
      if (miss < best_miss) {
        best_miss = miss;
        predicted = nearest_level(here * scale, plane_step_m_);
      }
    }
    const double miss_steps = best_miss / plane_step_m_;
    quality = miss_steps < 1.5 ? 0 : miss_steps < 4 ? 1 : miss_steps < 20 ? 2 : 3;
    if (quality == 3) predicted = anchor == 2 ? (levels[0] + levels[1]) / 2 : levels[0];
    return predicted;
  }

  static constexpr double kFarthestPrediction_m = 250;

  Coder& coder_;
  const AngularGrid& grid_;
  double plane_step_m_;
  const KeyFrame* key_;

  AdaptiveBit continue_[4][3][4][2];
  AdaptiveBit plane_[4][3][2];
  AdaptiveBit temporal_[4][3];
  AdaptiveInteger shift_;
  AdaptiveInteger level_[3][4];
  std::vector<Plane> candidates_;
  std::int32_t last_level_ = 1;
  std::int32_t last_key_run_ = kUnfitTile;
};

}  // namespace pointreel
