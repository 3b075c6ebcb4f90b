#include "codec/corrections.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace pointreel {
namespace {

RC_GTEST_PROP(Corrections, BringPointsWithinTheBound, ()) {
  const double max_error_m = *rc::gen::element(0.0005, 0.003, 0.02, 1.0);
  const CorrectionSteps steps(max_error_m);
  const auto coordinate = [&] {
    return static_cast<float>(0.99 * steps.reach_m() * *rc::gen::inRange(-1'000'000, 1'000'001) / 1e6);
  };
  const Point3f original{coordinate(), coordinate(), coordinate()};
  const auto off = [&](float x) { return x + static_cast<float>(*rc::gen::inRange(-1000, 1001)) * 1e-4F; };
  const Point3f decoded{off(original.x), off(original.y), off(original.z)};
  const Point3f corrected = steps.apply(decoded, steps.between(0, decoded, original));
  RC_ASSERT(distance_m(corrected, original) <= max_error_m);
}

RC_GTEST_PROP(Corrections, ComeBackFromBytes, ()) {
  std::vector<Correction> corrections;
  std::uint32_t index = 0;
  const int count = *rc::gen::inRange(0, 50);
  for (int i = 0; i < count; ++i) {
    index += *rc::gen::inRange(i == 0 ? 0u : 1u, 1000u);
    const auto step = [] { return *rc::gen::inRange(-200, 200); };
    corrections.push_back({index, {step(), step(), step()}});
  }
  const auto decoded = decode_corrections(encode_corrections(corrections), index + 1);
  RC_ASSERT(static_cast<bool>(decoded));
  RC_ASSERT(decoded->size() == corrections.size());
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    RC_ASSERT((*decoded)[i].index == corrections[i].index);
    RC_ASSERT((*decoded)[i].steps == corrections[i].steps);
  }
  if (!corrections.empty()) RC_ASSERT(!decode_corrections(encode_corrections(corrections), index));
}

}  // namespace
}  // namespace pointreel
