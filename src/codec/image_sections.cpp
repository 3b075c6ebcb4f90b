#include "codec/image_sections.h"

#include <vector>

#include "base/parallel.h"
#include "codec/relative_pose.h"
#include "codec/sections.h"
#include "predict/band_coding.h"
#include "predict/priors.h"
#include "predict/warp.h"

namespace pointreel {
namespace {

ReferenceImage reference_image(const ImageSetting& setting, const ReferenceSweep& reference, const Pose& T_ref_cur) {
  return warp(setting.model, setting.grid, reference, T_ref_cur, setting.threads);
}

}  // namespace

void encode_image(const ImageSetting& setting, const Prediction* prediction, GridImage& image, ByteWriter& writer,
                  FrameStatistics& statistics) {
  const CodingKind kind{prediction != nullptr, setting.effort};
  ReferenceImage reference;
  if (prediction != nullptr) {
    const std::size_t before = writer.size();
    put_relative_pose(writer, prediction->T_ref_cur);
    statistics.grid_bits += bits_of(writer.size() - before);
    reference = reference_image(setting, prediction->reference, *quantised(prediction->T_ref_cur));
  }
  const BandSetting band_setting{kind, setting.quantiser, &reference};
  const auto bands = bands_of(image.rows, image.columns);
  std::vector<CodedBand> coded(bands.size());
  parallel_for(bands.size(), setting.threads, [&](std::size_t b) {
    BandState state = state_from_priors(kind, setting.quantiser.step_m, bands[b]);
    coded[b] = encode_band(band_setting, bands[b], image, state);
  });
  for (const CodedBand& band : coded) {
    put_section(writer, band.mask);
    put_section(writer, band.ranges);
    statistics.occupancy_bits += bits_of(band.mask.size());
    statistics.range_bits += bits_of(band.ranges.size());
  }
}

Result<void> decode_image(const ImageSetting& setting, const ReferenceSweep* reference_sweep, ByteReader& reader,
                          GridImage& image) {
  const CodingKind kind{reference_sweep != nullptr, setting.effort};
  Pose T_ref_cur = Pose::Identity();
  if (reference_sweep != nullptr) {
    const auto pose = get_relative_pose(reader);
    if (!pose) return pose.error();
    T_ref_cur = *pose;
  }
  const auto bands = bands_of(image.rows, image.columns);
  std::vector<std::span<const std::uint8_t>> masks(bands.size()), ranges(bands.size());
  for (std::size_t b = 0; b < bands.size(); ++b) {
    masks[b] = get_section(reader);
    ranges[b] = get_section(reader);
  }
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its ranges"};
  ReferenceImage reference;
  if (reference_sweep != nullptr) reference = reference_image(setting, *reference_sweep, T_ref_cur);
  const BandSetting band_setting{kind, setting.quantiser, &reference};
  std::vector<Result<void>> results(bands.size());
  parallel_for(bands.size(), setting.threads, [&](std::size_t b) {
    BandState state = state_from_priors(kind, setting.quantiser.step_m, bands[b]);
    results[b] = decode_band(band_setting, bands[b], masks[b], ranges[b], image, state);
  });
  for (const auto& result : results) {
    if (!result) return result.error();
  }
  return {};
}

}  // namespace pointreel
