#include "codec/image_sections.h"

#include <vector>

#include "base/parallel.h"
#include "codec/sections.h"
#include "predict/band_coding.h"
#include "predict/priors.h"
#include "predict/warp.h"

namespace pointreel {
namespace {

ReferenceImage reference_image(const ImageSetting& setting, const Prediction* prediction) {
  if (prediction == nullptr) return {};
  return warp(setting.model, setting.grid, prediction->reference, prediction->T_ref_cur, setting.threads);
}

// One a band: what the reference's bands have taught, or the priors where it has other bands or none.
std::vector<BandState> starting_states(const CodingKind& kind, float step_m, const std::vector<Band>& bands,
                                       const Prediction* prediction) {
  if (prediction != nullptr && prediction->reference.states.size() == bands.size())
    return prediction->reference.states;
  std::vector<BandState> states;
  for (const Band& band : bands) states.push_back(state_from_priors(kind, step_m, band));
  return states;
}

}  // namespace

std::vector<BandState> encode_image(const ImageSetting& setting, const Prediction* prediction,
                                    GridImage& image, ByteWriter& writer, FrameStatistics& statistics) {
  const CodingKind kind{prediction != nullptr, setting.effort};
  const ReferenceImage reference = reference_image(setting, prediction);
  const BandSetting band_setting{kind, setting.quantiser, &reference, {}, setting.known_range_m};
  const auto bands = bands_of(image.rows, image.columns);
  auto states = starting_states(kind, setting.quantiser.step_m, bands, prediction);
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

Result<std::vector<BandState>> decode_image(const ImageSetting& setting, const Prediction* prediction,
                                            ByteReader& reader, GridImage& image) {
  const CodingKind kind{prediction != nullptr, setting.effort};
  const auto bands = bands_of(image.rows, image.columns);
  std::vector<std::span<const std::uint8_t>> masks(bands.size()), ranges(bands.size());
  for (std::size_t b = 0; b < bands.size(); ++b) {
    masks[b] = get_section(reader);
    ranges[b] = get_section(reader);
  }
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its ranges"};
  const ReferenceImage reference = reference_image(setting, prediction);
  const BandSetting band_setting{kind, setting.quantiser, &reference, {}, setting.known_range_m};
  auto states = starting_states(kind, setting.quantiser.step_m, bands, prediction);
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
