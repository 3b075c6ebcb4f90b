// What each ingredient of method `mixture` is worth: bits per point of the image without it.
//
//   ablation SWEEP... [--max-error METRES]
//
// Frames by themselves and frames predicted from the sweep before, each from the priors, as the codec does
// it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "predict/band_coding.h"
#include "predict/priors.h"
#include "training_images.h"
#include "untrained_state.h"

namespace pointreel {
namespace {

struct Bits {
  double mask = 0, ranges = 0, points = 0;
  double per_point() const { return (mask + ranges) / points; }
};

struct Variant {
  Ingredients ingredients;
  bool priors = true;        // false: the state as new
  bool keeps_state = false;  // from sweep to sweep
};

// All frames of `kind`; the first of a drive, which nothing can predict, is left out.
Bits bits_of(const std::vector<TrainingDrive>& drives, const CodingKind& kind, float step_m,
             const Variant& variant) {
  const RangeQuantiser quantiser{step_m, {}};
  Bits bits;
  for (const TrainingDrive& drive : drives) {
    std::vector<float> previous_m;
    std::vector<BandState> states;
    for (std::size_t i = 0; i < drive.sweeps.size(); ++i) {
      GridImage image = drive.sweeps[i].image;
      const bool counts = i > 0 && drive.sweeps[i].motion.has_value();
      const CodingKind this_kind{kind.predicted && counts, kind.effort};
      ReferenceImage reference;
      if (this_kind.predicted) reference = reference_of(drive, i, previous_m);
      const auto bands = choose_bands(image, step_m);
      if (!variant.keeps_state || i < 2 || states.size() != bands.size()) states.clear();
      for (std::size_t b = 0; b < bands.size(); ++b) {
        if (states.size() == b) {
          states.push_back(variant.priors ? state_from_priors(this_kind, step_m, bands[b])
                                          : untrained(this_kind, bands[b].rows));
        }
        const CodedBand coded =
            encode_band({this_kind, quantiser, &reference, variant.ingredients}, bands[b], image, states[b]);
        if (!counts) continue;
        bits.mask += 8.0 * static_cast<double>(coded.mask.size());
        bits.ranges += 8.0 * static_cast<double>(coded.ranges.size());
      }
      if (counts) {
        for (const float range_m : image.range_m) bits.points += range_m > 0 ? 1 : 0;
      }
      previous_m = std::move(image.range_m);
    }
  }
  return bits;
}

void report(const std::vector<TrainingDrive>& drives, const char* frames, const CodingKind& kind,
            float step_m, const std::vector<std::pair<const char*, std::uint32_t>>& experts) {
  const double all = bits_of(drives, kind, step_m, {}).per_point();
  const auto print = [&](const std::string& name, const Variant& variant) {
    const Bits bits = bits_of(drives, kind, step_m, variant);
    fmt::print("| {:<58} | {:.3f} | {:.3f} | {:+.1f} % |\n", name, bits.mask / bits.points,
               bits.ranges / bits.points, 100 * (bits.per_point() / all - 1));
  };
  fmt::print("| {:<58} | mask | ranges | against all |\n|---|---|---|---|\n",
             fmt::format("{}, step {:g} m: bits per point", frames, step_m));
  print("all ingredients", {});
  print("state kept from sweep to sweep", {{}, true, true});
  print("without priors (state as new)", {{}, false, false});
  print("without the second stage", {{0, 0.2F, 0.08F, false}});
  print("weights do not learn", {{0, 0, 0.08F}});
  print("scales do not learn", {{0, 0.2F, 0}});
  for (const auto& [name, lanes] : experts) print(fmt::format("without {}", name), {{lanes}});
  fmt::print("\n");
}

constexpr std::uint32_t lanes(std::initializer_list<int> list) {
  std::uint32_t bits = 0;
  for (const int lane : list) bits |= 1U << lane;
  return bits;
}

// Lanes as in predict/experts-inl.h.
void report_all(const std::vector<TrainingDrive>& drives, float step_m) {
  report(drives, "frames by themselves", {false, Effort::balanced}, step_m,
         {{"the local plane", lanes({1})},
          {"the line in the row", lanes({8})},
          {"the parallel to the row above", lanes({9})},
          {"the three fits", lanes({1, 8, 9})},
          {"the second and third range to the left", lanes({12, 13})},
          {"the ranges behind edges", lanes({4, 15})},
          {"the row above (as expert)", lanes({3, 7, 10, 11})}});
  report(drives, "predicted frames", {true, Effort::balanced}, step_m,
         {{"the lines and the step from above", lanes({1, 8, 9})},
          {"the range behind the last edge", lanes({4})},
          {"the reference's cell", lanes({5})},
          {"the reference's step from the left", lanes({7})},
          {"the reference's neighbour to the right", lanes({6})},
          {"the reference's mean", lanes({11})},
          {"the reference (as expert)", lanes({5, 6, 7, 11})}});
  const CodingKind efforts[] = {{false, Effort::fast}, {true, Effort::balanced}, {true, Effort::max}};
  const char* names[] = {"fast", "balanced", "max"};
  fmt::print("| effort, step {:g} m | bits per point |\n|---|---|\n", step_m);
  for (std::size_t i = 0; i < 3; ++i)
    fmt::print("| {} | {:.3f} |\n", names[i], bits_of(drives, efforts[i], step_m, {}).per_point());
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  CLI::App app("What each ingredient of method mixture is worth");
  std::vector<std::string> sweeps;
  double max_error_m = 0.02;
  app.add_option("SWEEP", sweeps, "Sweeps: files, folders or globs; consecutive ones of a folder")
      ->required();
  app.add_option("--max-error", max_error_m, "Bound in metres; ranges have steps of twice that")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  pointreel::report_all(pointreel::training_drives(sweeps), static_cast<float>(2 * max_error_m));
  return 0;
}
