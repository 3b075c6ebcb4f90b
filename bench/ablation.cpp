// What each ingredient of method `mixture` is worth: bits per point of the ranges without it.
//
//   ablation SWEEP... [--max-error METRES]
//
// Sweeps are coded one by one, from the priors, as the codec does it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#define HWY_COMPILE_ONLY_STATIC
#include "entropy/adaptive_models.h"
#include "predict/band_coding.h"
#include "predict/range_model-inl.h"
#include "require.h"
#include "training_images.h"

HWY_BEFORE_NAMESPACE();
namespace pointreel {
namespace HWY_NAMESPACE {

template <class Ingredients>
double range_bits(const GridImage& image, const RangeQuantiser& quantiser, const RangeModelState* start) {
  double bits = 0;
  for (const Band& band : bands_of(image.rows, image.columns)) {
    RangeModelState state = start != nullptr ? *start : RangeModelState::from_priors(quantiser.step_m);
    RangeModel<Ingredients> model(band, image.columns, quantiser, state);
    BitEncoder coder;
    for (int row = 0; row < band.rows; ++row) {
      model.start_row(row, 0);
      for (int column = 0; column < image.columns; ++column) {
        const float range_m = image.range_m[image.index(band.first_row + row, column)];
        if (range_m > 0) model.code(coder, column, range_m);
      }
    }
    bits += 8.0 * static_cast<double>(coder.finish().size());
  }
  return bits;
}

// Lanes as in experts-inl.h.
template <std::uint32_t kOff>
struct WithoutExperts : AllIngredients {
  static constexpr std::uint32_t kExpertsOff = kOff;
};
struct WithoutSecondStage : AllIngredients {
  static constexpr bool kSecondStage = false;
};
struct FixedWeights : AllIngredients {
  static constexpr bool kLearnsWeights = false;
};
struct FixedScales : AllIngredients {
  static constexpr bool kLearnsScales = false;
};

template <class Ingredients>
double bits_of_all(const std::vector<TrainingImage>& images, const RangeQuantiser& quantiser,
                   const RangeModelState* start = nullptr) {
  double bits = 0;
  for (const TrainingImage& training : images)
    bits += range_bits<Ingredients>(training.image, quantiser, start);
  return bits;
}

struct CodedBits {
  double mask = 0, ranges = 0;
  double sum() const { return mask + ranges; }
};

// Each sweep from the priors, or with what the sweeps before have taught.
CodedBits coded_bits(const std::vector<TrainingImage>& images, const RangeQuantiser& quantiser,
                     bool keeps_state) {
  CodedBits bits;
  std::vector<BandState> states;
  for (const TrainingImage& training : images) {
    GridImage image = training.image;
    const auto bands = bands_of(image.rows, image.columns);
    if (!keeps_state || !training.follows_previous || states.size() != bands.size()) states.clear();
    for (std::size_t b = 0; b < bands.size(); ++b) {
      if (states.size() == b) states.push_back(BandState::from_priors(quantiser, bands[b]));
      const CodedBand coded = encode_band(quantiser, bands[b], image, states[b]);
      bits.mask += 8.0 * static_cast<double>(coded.mask.size());
      bits.ranges += 8.0 * static_cast<double>(coded.ranges.size());
    }
  }
  return bits;
}

void report(const std::vector<TrainingImage>& images, float step_m) {
  const RangeQuantiser quantiser{step_m, {}};
  double points = 0;
  const CodedBits alone = coded_bits(images, quantiser, false);
  const CodedBits running = coded_bits(images, quantiser, true);
  for (const TrainingImage& training : images) {
    for (const float range_m : training.image.range_m) points += range_m > 0 ? 1 : 0;
  }
  const double all = bits_of_all<AllIngredients>(images, quantiser);
  const auto print = [&](const char* name, double bits) {
    fmt::print("| {:<58} | {:.3f} | {:+.1f} % |\n", name, bits / points, 100 * (bits / all - 1));
  };
  const RangeModelState untrained;
  fmt::print("| {:<58} | bpp | against all |\n|---|---|---|\n",
             "ranges, step " + fmt::format("{:g} m", step_m));
  print("all ingredients", all);
  print("without priors (state as new)", bits_of_all<AllIngredients>(images, quantiser, &untrained));
  print("without the second stage", bits_of_all<WithoutSecondStage>(images, quantiser));
  print("weights do not learn", bits_of_all<FixedWeights>(images, quantiser));
  print("scales do not learn", bits_of_all<FixedScales>(images, quantiser));
  print("without the local plane", bits_of_all<WithoutExperts<1 << 2>>(images, quantiser));
  print("without the line in the row", bits_of_all<WithoutExperts<1 << 3>>(images, quantiser));
  print("without the parallel to the row above", bits_of_all<WithoutExperts<1 << 4>>(images, quantiser));
  print("without the three fits", bits_of_all<WithoutExperts<0b11100>>(images, quantiser));
  print("without the second and third range to the left",
        bits_of_all<WithoutExperts<0b11 << 11>>(images, quantiser));
  print("without the ranges behind edges", bits_of_all<WithoutExperts<0b11 << 14>>(images, quantiser));
  print("without the row above (as expert)", bits_of_all<WithoutExperts<0b1111 << 7>>(images, quantiser));
  print("blend and first guess only", bits_of_all<WithoutExperts<0xFFBE>>(images, quantiser));
  fmt::print("\nhit mask: {:.3f} bpp\n", alone.mask / points);
  fmt::print(
      "mask and ranges: {:.3f} bpp each sweep by itself, {:.3f} with the state kept from sweep to sweep "
      "({:+.1f} %)\n",
      alone.sum() / points, running.sum() / points, 100 * (alone.sum() / running.sum() - 1));
}

}  // namespace HWY_NAMESPACE
}  // namespace pointreel
HWY_AFTER_NAMESPACE();

int main(int argc, char** argv) {
  CLI::App app("What each ingredient of method mixture is worth");
  std::vector<std::string> sweeps;
  double max_error_m = 0.02;
  app.add_option("SWEEP", sweeps, "Sweeps: files, folders or globs")->required();
  app.add_option("--max-error", max_error_m, "Bound in metres; ranges have steps of twice that")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    pointreel::HWY_NAMESPACE::report(pointreel::training_images(sweeps), static_cast<float>(2 * max_error_m));
  } catch (const std::exception& error) {
    fmt::print(stderr, "ablation: {}\n", error.what());
    return 1;
  }
  return 0;
}
