// Trains the hit mask's priors, and measures what the mask costs.
//
//   train_hit_mask SWEEP... > src/predict/hit_mask_priors.cpp     trains
//   train_hit_mask --measure [--bands N] SWEEP...                  bits per point with the priors compiled in
//
// The reference of a sweep is the mask of the sweep before it, where both come from one folder.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "entropy/adaptive_models.h"
#include "predict/hit_mask.h"
#include "prior_tables.h"
#include "training_images.h"

namespace pointreel {
namespace {

struct GridSweep {
  std::int32_t rows = 0;
  std::int32_t columns = 0;
  std::vector<float> range_m;
  std::vector<std::uint8_t> reference;

  bool has_reference() const {
    return std::any_of(reference.begin(), reference.end(), [](std::uint8_t cell) { return cell != 0; });
  }
  auto points() const {
    return std::count_if(range_m.begin(), range_m.end(), [](float r) { return r > 0; });
  }
};

std::vector<GridSweep> grid_sweeps(const std::vector<std::string>& paths) {
  std::vector<GridSweep> sweeps;
  for (TrainingImage& training : training_images(paths)) {
    GridSweep sweep{training.image.rows, training.image.columns, std::move(training.image.range_m), {}};
    sweep.reference.resize(sweep.range_m.size());
    if (training.follows_previous && !sweeps.empty() && sweeps.back().rows == sweep.rows) {
      const GridSweep& before = sweeps.back();
      for (std::size_t i = 0; i < sweep.range_m.size(); ++i) {
        const auto columns = static_cast<std::size_t>(sweep.columns);
        const auto columns_before = static_cast<std::size_t>(before.columns);
        const std::size_t column = i % columns * columns_before / columns;
        if (before.range_m[i / columns * columns_before + column] > 0) sweep.reference[i] = kPreviousHit;
      }
    }
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

HitMaskBand band_of(const GridSweep& sweep, int band, int bands) {
  const int first = sweep.rows * band / bands;
  return {first, sweep.rows * (band + 1) / bands - first, sweep.columns, sweep.rows};
}

std::span<const std::uint8_t> reference_of(const GridSweep& sweep, const HitMaskBand& band) {
  const auto columns = static_cast<std::size_t>(sweep.columns);
  return std::span(sweep.reference)
      .subspan(static_cast<std::size_t>(band.first_row) * columns,
               static_cast<std::size_t>(band.rows) * columns);
}

// Codes one band's mask. The model's contexts take the sweep's own ranges from a decoder as well: what is
// decoded is counted and timed, but not kept.
template <class Coder>
void code_band(Coder& coder, const GridSweep& sweep, HitMaskModel& model, const HitMaskBand& band) {
  const float* range = sweep.range_m.data() +
                       static_cast<std::size_t>(band.first_row) * static_cast<std::size_t>(band.columns);
  for (int row = 0; row < band.rows; ++row) {
    model.begin_row();
    for (int column = 0; column < band.columns; ++column, ++range) {
      if (model.code(coder, *range > 0)) model.set_range(*range);
    }
  }
}

// ---- training ----

// A coder that codes nothing.
struct NoCoder {
  static bool code_with(bool bit, Probability16) { return bit; }
};

HitMaskState untrained() {
  HitMaskState state;
  for (std::size_t context = 0; context < HitMaskState::kContexts; ++context)
    state.bits[context].resize(static_cast<std::size_t>(HitMaskState::kSlots[context]));
  state.mixers.fill(HitMaskState::Mixer::with_weights(HitMaskState::Mixer::kOne / 5));
  return state;
}

// Rows share one set of slots in training, so that the priors do not know one sensor's rows.
void train(HitMaskState& state, const GridSweep& sweep, bool with_reference, int bands) {
  for (int b = 0; b < bands; ++b) {
    const HitMaskBand band = band_of(sweep, b, bands);
    HitMaskState per_row = state;
    auto& row_bits = per_row.bits[HitMaskState::kRow];
    const std::vector<CountedBit> shared = row_bits;
    for (int row = 1; row < band.rows; ++row) row_bits.insert(row_bits.end(), shared.begin(), shared.end());
    HitMaskModel model(band, with_reference ? reference_of(sweep, band) : std::span<const std::uint8_t>(),
                       std::move(per_row));
    NoCoder coder;
    code_band(coder, sweep, model, band);

    state = model.state();
    auto& trained = state.bits[HitMaskState::kRow];
    std::vector<CountedBit> merged;
    for (std::size_t slot = 0; slot < shared.size(); ++slot) {
      double bits = 0;
      double ones = 0;
      for (std::size_t i = slot; i < trained.size(); i += shared.size()) {
        const double seen = trained[i].count() + 0.01;
        bits += seen;
        ones += seen * trained[i].p_one();
      }
      merged.emplace_back(
          static_cast<Probability16>(ones / bits),
          static_cast<std::uint32_t>(std::min<double>(bits / band.rows, CountedBit::kMaxCount)));
    }
    trained = merged;
  }
}

void print_priors(const HitMaskState& state) {
  std::vector<int> bytes;
  for (const auto& bits : state.bits) {
    for (const CountedBit& bit : bits) bytes.push_back(prior_byte(bit.p_one(), bit.count()));
  }
  std::vector<int> weights;
  for (const auto& mixer : state.mixers) {
    for (std::size_t input = 0; input < HitMaskState::kContexts; ++input)
      weights.push_back(prior_weight(mixer, input));
  }
  fmt::print(
      "// Made by bench/train_hit_mask.\n#include \"predict/hit_mask_priors.h\"\n\nnamespace pointreel {{\n\n"
      "// clang-format off\nconst std::array<std::uint8_t, kHitMaskPriorSlots> kHitMaskPriors = {{\n");
  print_list(bytes);
  fmt::print(
      "}};\n\nconst std::array<std::int16_t, HitMaskState::kMixers * HitMaskState::kContexts> "
      "kHitMaskWeights = {{\n");
  print_list(weights);
  fmt::print("}};\n// clang-format on\n\n}}  // namespace pointreel\n");
}

// ---- measuring ----

struct Cost {
  double bits = 0;
  double seconds_encoding = 0;
  double seconds_decoding = 0;
};

Cost cost_of(const GridSweep& sweep, int bands, bool with_reference) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  Cost cost;
  for (int b = 0; b < bands; ++b) {
    const HitMaskBand band = band_of(sweep, b, bands);
    const auto reference = with_reference ? reference_of(sweep, band) : std::span<const std::uint8_t>();
    const auto start = Clock::now();
    BitEncoder encoder;
    HitMaskModel encoding(band, reference, HitMaskState::from_priors(band.rows));
    code_band(encoder, sweep, encoding, band);
    const std::vector<std::uint8_t> bytes = encoder.finish();
    const auto encoded = Clock::now();
    BitDecoder decoder(bytes);
    HitMaskModel decoding(band, reference, HitMaskState::from_priors(band.rows));
    code_band(decoder, sweep, decoding, band);
    cost.bits += 8.0 * static_cast<double>(bytes.size());
    cost.seconds_encoding += seconds(encoded - start);
    cost.seconds_decoding += seconds(Clock::now() - encoded);
  }
  return cost;
}

void measure(const std::vector<GridSweep>& sweeps, int bands, bool with_reference) {
  Cost sum;
  double points = 0;
  std::vector<double> encode_ms;
  std::vector<double> decode_ms;
  for (const GridSweep& sweep : sweeps) {
    const Cost cost = cost_of(sweep, bands, with_reference && sweep.has_reference());
    sum.bits += cost.bits;
    encode_ms.push_back(1e3 * cost.seconds_encoding);
    decode_ms.push_back(1e3 * cost.seconds_decoding);
    points += static_cast<double>(sweep.points());
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
  };
  fmt::print(
      "{:<18} {} sweeps, {} bands: {:.4f} bits per point, encode {:.2f} ms, decode {:.2f} ms per sweep\n",
      with_reference ? "with reference" : "without reference", sweeps.size(), bands, sum.bits / points,
      median(encode_ms), median(decode_ms));
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Trains the hit mask's priors, and measures what the mask costs.");
  std::vector<std::string> paths;
  bool measuring = false;
  int bands = 1;
  app.add_option("SWEEP", paths, "Sweeps: files, folders or globs")->required();
  app.add_flag("--measure", measuring, "measure instead of training");
  app.add_option("--bands", bands, "bands of rows, measured with a state each")->check(CLI::Range(1, 16));
  CLI11_PARSE(app, argc, argv);

  const std::vector<GridSweep> sweeps = grid_sweeps(paths);
  if (measuring) {
    measure(sweeps, bands, false);
    measure(sweeps, bands, true);
    return 0;
  }
  HitMaskState state = untrained();
  int turn = 0;
  for (const GridSweep& sweep : sweeps) {
    const int training_bands = turn++ % 2 == 0 ? 1 : 3;
    train(state, sweep, false, training_bands);
    if (sweep.has_reference()) train(state, sweep, true, training_bands);
  }
  print_priors(state);
  return 0;
}

}  // namespace pointreel

int main(int argc, char** argv) {
  return pointreel::run(argc, argv);
}
