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

ReferenceImage reference_image(const ImageSetting& setting, const ReferenceSweep& reference,
                               const Pose& T_ref_cur) {
  return warp(setting.model, setting.grid, reference, T_ref_cur, setting.threads);
}

// One a band: what the reference's bands have taught, or the priors where it has other bands or none.
std::vector<BandState> starting_states(const CodingKind& kind, float step_m, const std::vector<Band>& bands,
                                       const ReferenceSweep* reference) {
  if (reference != nullptr && reference->states.size() == bands.size()) return reference->states;
  std::vector<BandState> states;
  for (const Band& band : bands) states.push_back(state_from_priors(kind, step_m, band));
  return states;
}

}  // namespace

std::vector<BandState> encode_image(const ImageSetting& setting, const Prediction* prediction,
                                    GridImage& image, ByteWriter& writer, FrameStatistics& statistics) {
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
  auto states = starting_states(kind, setting.quantiser.step_m, bands,
                                prediction != nullptr ? &prediction->reference : nullptr);
  std::vector<CodedBand> coded(bands.size());
  parallel_for(bands.size(), setting.threads,
               [&](std::size_t b) { coded[b] = encode_band(band_setting, bands[b], image, states[b]); });
  for (const CodedBand& band : coded) {
    put_section(writer, band.mask);
    put_section(writer, band.ranges);
    statistics.occupancy_bits += bits_of(band.mask.size());
    statistics.range_bits += bits_of(band.ranges.size());
  }
  if (!kind.predicted) states.clear();
  return states;
}

Result<std::vector<BandState>> decode_image(const ImageSetting& setting,
                                            const ReferenceSweep* reference_sweep, ByteReader& reader,
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
  auto states = starting_states(kind, setting.quantiser.step_m, bands, reference_sweep);
  std::vector<Result<void>> results(bands.size());
  parallel_for(bands.size(), setting.threads, [&](std::size_t b) {
    results[b] = decode_band(band_setting, bands[b], masks[b], ranges[b], image, states[b]);
  });
  for (const auto& result : results) {
    if (!result) return result.error();
  }
  if (!kind.predicted) states.clear();
  return states;
}

}  // namespace pointreel
