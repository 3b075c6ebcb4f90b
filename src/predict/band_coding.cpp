#include "predict/band_coding.h"

#include <string>

#include "base/simd_targets.h"

#define HWY_TARGET_INCLUDE "predict/band_coding.cpp"
#include "hwy/foreach_target.h"
//
#include "entropy/adaptive_models.h"
#include "predict/band_coder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <class Coder>
bool code(Coder& mask, Coder& ranges, const BandSetting& setting, const Band& band, GridImage& image,
          BandState& state) {
  const CodingKind& kind = setting.kind;
  if (kind.effort == Effort::fast)
    return code_band<Effort::fast, false>(mask, ranges, setting, band, image, state);
  if (!kind.predicted) return code_band<Effort::balanced, false>(mask, ranges, setting, band, image, state);
  if (kind.effort == Effort::balanced)
    return code_band<Effort::balanced, true>(mask, ranges, setting, band, image, state);
  return code_band<Effort::max, true>(mask, ranges, setting, band, image, state);
}

CodedBand encode(const BandSetting& setting, const Band& band, GridImage& image, BandState& state) {
  BitEncoder mask, ranges;
  code(mask, ranges, setting, band, image, state);
  return {mask.finish(), ranges.finish()};
}

bool decode(const BandSetting& setting, const Band& band, std::span<const std::uint8_t> mask_bytes,
            std::span<const std::uint8_t> range_bytes, GridImage& image, BandState& state) {
  BitDecoder mask(mask_bytes), ranges(range_bytes);
  return code(mask, ranges, setting, band, image, state);
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pointreel {

HWY_EXPORT(encode);
HWY_EXPORT(decode);

CodedBand encode_band(const BandSetting& setting, const Band& band, GridImage& image, BandState& state) {
  return HWY_DYNAMIC_DISPATCH(encode)(setting, band, image, state);
}

Result<void> decode_band(const BandSetting& setting, const Band& band, std::span<const std::uint8_t> mask,
                         std::span<const std::uint8_t> ranges, GridImage& image, BandState& state) {
  if (!HWY_DYNAMIC_DISPATCH(decode)(setting, band, mask, ranges, image, state)) {
    return Error{ErrorCode::truncated, "the ranges end before the last of rows " +
                                           std::to_string(band.first_row) + " to " +
                                           std::to_string(band.first_row + band.rows - 1)};
  }
  return {};
}

}  // namespace pointreel
#endif  // HWY_ONCE
