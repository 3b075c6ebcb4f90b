#include "codec/image_sections.h"

#include <algorithm>
#include <string>
#include <vector>

#include "codec/sections.h"
#include "predict/band_coding.h"
#include "predict/priors.h"

namespace pointreel {
namespace {

// nullptr for a frame by itself.
const ReferenceImage* reference_image(const ImageSetting& setting, const Prediction* prediction) {
  if (prediction == nullptr) return nullptr;
  return &warp(setting.model, setting.grid, prediction->reference, prediction->motion, setting.threads,
               setting.warp_memory);
}

// Where what the reference's bands have taught is for these, too.
bool same_bands(const std::vector<BandState>& states, const std::vector<Band>& bands) {
  return std::equal(states.begin(), states.end(), bands.begin(), bands.end(),
                    [](const BandState& state, const Band& band) {
                      return state.mask.rows() == static_cast<std::size_t>(band.rows);
                    });
}

// One a band: what the reference's bands have taught, or the priors where it has other bands or none.
std::vector<BandState> starting_states(const CodingKind& kind, float step_m, const std::vector<Band>& bands,
                                       const Prediction* prediction) {
  if (prediction != nullptr && same_bands(prediction->reference.states, bands))
    return prediction->reference.states;
  std::vector<BandState> states;
  states.reserve(bands.size());
  for (const Band& band : bands) states.push_back(state_from_priors(kind, step_m, band));
  return states;
}

// The bands of the reference, to go on with what they have taught.
std::vector<Band> bands_of(const std::vector<BandState>& states) {
  std::vector<Band> bands;
  int first_row = 0;
  for (const BandState& state : states) {
    bands.push_back({first_row, static_cast<int>(state.mask.rows())});
    first_row += bands.back().rows;
  }
  return bands;
}

void put_bands(ByteWriter& writer, const std::vector<Band>& bands) {
  writer.put(static_cast<std::uint16_t>(bands.size()));
  for (const Band& band : bands) writer.put(static_cast<std::uint16_t>(band.rows));
}

Result<std::vector<Band>> get_bands(ByteReader& reader, int rows) {
  const auto count = reader.get<std::uint16_t>();
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends before its bands of rows"};
  std::vector<Band> bands;
  int first_row = 0;
  for (int i = 0; i < count; ++i) {
    bands.push_back({first_row, reader.get<std::uint16_t>()});
    if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its bands of rows"};
    first_row += bands.back().rows;
    if (bands.back().rows < 1 || first_row > rows) break;
  }
  if (bands.empty() || bands.back().rows < 1 || first_row != rows)
    return Error{ErrorCode::corrupt, "its bands do not make up its " + std::to_string(rows) + " rows"};
  return bands;
}

}  // namespace

std::vector<BandState> encode_image(const ImageSetting& setting, const Prediction* prediction,
                                    GridImage& image, ByteWriter& writer, FrameStatistics& statistics) {
  const CodingKind kind{prediction != nullptr, setting.effort};
  const BandSetting band_setting{
      kind, setting.quantiser, reference_image(setting, prediction), {}, setting.known_range_m};
  const bool goes_on = prediction != nullptr && !prediction->reference.states.empty();
  const auto bands = goes_on ? bands_of(prediction->reference.states)
                             : choose_bands(image, setting.quantiser.step_m, setting.threads);
  put_bands(writer, bands);
  auto states = starting_states(kind, setting.quantiser.step_m, bands, prediction);
  std::vector<CodedBand> coded(bands.size());
  parallel_for(bands.size(), setting.threads, setting.beside,
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
  const auto found_bands = get_bands(reader, image.rows);
  if (!found_bands) return found_bands.error();
  const std::vector<Band>& bands = *found_bands;
  std::vector<std::span<const std::uint8_t>> masks(bands.size()), ranges(bands.size());
  for (std::size_t b = 0; b < bands.size(); ++b) {
    masks[b] = get_section(reader);
    ranges[b] = get_section(reader);
  }
  if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its ranges"};
  const BandSetting band_setting{
      kind, setting.quantiser, reference_image(setting, prediction), {}, setting.known_range_m};
  auto states = starting_states(kind, setting.quantiser.step_m, bands, prediction);
  std::vector<Result<void>> results(bands.size());
  parallel_for(bands.size(), setting.threads, setting.beside, [&](std::size_t b) {
    results[b] = decode_band(band_setting, bands[b], masks[b], ranges[b], image, states[b]);
  });
  for (const auto& result : results) {
    if (!result) return result.error();
  }
  if (!kind.predicted) states.clear();
  return states;
}

}  // namespace pointreel
