// What the rows of a scan remember of their own earlier returns, across cells without one.

#if defined(POINTREEL_PREDICT_ROW_MEMORY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef POINTREEL_PREDICT_ROW_MEMORY_INL_H_
#undef POINTREEL_PREDICT_ROW_MEMORY_INL_H_
#else
#define POINTREEL_PREDICT_ROW_MEMORY_INL_H_
#endif

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

// Eight rows at once.
class RowMemory {
 public:
  POINTREEL_INLINE RowMemory()
      : last_m_(all<8>(0)),
        before_last_m_(last_m_),
        edge_m_(last_m_),
        earlier_edge_m_(last_m_),
        age_(all<8>(kNever)),
        gap_(age_) {}

  // Ranges of the last two returns, 0 when they are more than kReach columns back.
  POINTREEL_INLINE Float8 last_m() const { return where(age_ <= all<8>(kReach), last_m_); }
  POINTREEL_INLINE Float8 before_last_m() const {
    return where((age_ <= all<8>(kReach)) & (gap_ <= all<8>(kReach)), before_last_m_);
  }
  // Ranges before the last two depth edges, or 0: behind a pole the wall goes on.
  POINTREEL_INLINE const Float8& edge_m() const { return edge_m_; }
  POINTREEL_INLINE const Float8& earlier_edge_m() const { return earlier_edge_m_; }

  // The next cells; range 0: no return.
  POINTREEL_INLINE void add(const Float8& range_m) {
    const Mask<8> hit = seen(range_m);
    const Float8 last = last_m();
    const Mask<8> edge = hit & seen(last) & (all<8>(kEdgeM) + kEdgeShare * last <= absolute(range_m - last));
    earlier_edge_m_ = select(edge, edge_m_, earlier_edge_m_);
    edge_m_ = select(edge, last, edge_m_);
    before_last_m_ = select(hit, last_m_, before_last_m_);
    gap_ = select(hit, age_, gap_);
    last_m_ = select(hit, range_m, last_m_);
    age_ = select(hit, all<8>(1), age_ + all<8>(1));
  }

 private:
  static constexpr float kReach = 24;
  static constexpr float kNever = 1000;
  static constexpr float kEdgeM = 0.3F;  // a depth edge: ranges differ by this and by a share of the range
  static constexpr float kEdgeShare = 0.02F;

  Float8 last_m_, before_last_m_, edge_m_, earlier_edge_m_;
  Float8 age_, gap_;  // columns back to the last return, and from it to the one before
};

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#endif  // per target
