// What a row of a scan remembers of its own earlier returns, across cells without one.
#pragma once

#include <cmath>

namespace pointreel {

class RowMemory {
 public:
  void start_row() { *this = {}; }

  void add(int column, float range_m) {
    const float last = last_m(column);
    if (last > 0 && std::fabs(range_m - last) > kEdgeM + kEdgeShare * last) {
      earlier_edge_m_ = edge_m_;
      edge_m_ = last;
    }
    before_last_m_ = last_m_;
    before_last_column_ = last_column_;
    last_m_ = range_m;
    last_column_ = column;
  }

  // Ranges of the last two returns, 0 when they are more than kReach columns back.
  float last_m(int column) const { return column - last_column_ <= kReach ? last_m_ : 0; }
  float before_last_m(int column) const {
    return last_m(column) > 0 && last_column_ - before_last_column_ <= kReach ? before_last_m_ : 0;
  }
  // Ranges before the last two depth edges, or 0: behind a pole the wall goes on.
  float edge_m() const { return edge_m_; }
  float earlier_edge_m() const { return earlier_edge_m_; }

 private:
  static constexpr int kReach = 24;
  static constexpr int kNever = -1000;
  static constexpr float kEdgeM = 0.3F;  // a depth edge: ranges differ by this and by a share of the range
  static constexpr float kEdgeShare = 0.02F;
  float last_m_ = 0, before_last_m_ = 0, edge_m_ = 0, earlier_edge_m_ = 0;
  int last_column_ = kNever, before_last_column_ = kNever;
};

}  // namespace pointreel
