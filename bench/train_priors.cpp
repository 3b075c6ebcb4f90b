// Trains the priors of method `mixture`.
//
//   train_priors SWEEP... > src/predict/priors_data.cpp
//
// For each kind of frame and size of the step all sweeps are coded twice with a state that is never reset;
// the priors are the mean of what it was at the ends of the bands in the second pass. Predicted frames have
// the sweep before them as their reference, as it was decoded.
#include <CLI/CLI.hpp>
#include <utility>

#include "predict/band_coding.h"
#include "prior_trainer.h"
#include "training_images.h"
#include "untrained_state.h"

namespace pointreel {
namespace {

constexpr int kMostRows = 512;

struct Means {
  PriorMean ranges, mask;
};

Means train(const std::vector<TrainingDrive>& drives, const CodingKind& kind, float step_m) {
  const RangeQuantiser quantiser{step_m, {}};
  BandState running = untrained(kind, kMostRows);
  Means means;
  for (const bool counts : {false, true}) {
    for (const TrainingDrive& drive : drives) {
      std::vector<float> previous_m;
      for (std::size_t i = 0; i < drive.sweeps.size(); ++i) {
        GridImage image = drive.sweeps[i].image;
        ReferenceImage reference;
        const bool has_reference = i > 0 && drive.sweeps[i].motion.has_value();
        if (kind.predicted && has_reference) reference = reference_of(drive, i, previous_m);
        if (!kind.predicted || has_reference) {
          for (const Band& band : choose_bands(image, step_m)) {
            encode_band({kind, quantiser, &reference}, band, image, running);
            if (!counts) continue;
            means.ranges.start_visit();
            if (kind.effort == Effort::fast) {
              visit_fast_range_state(running.fast, means.ranges);
            } else if (has_trust(kind)) {
              visit_max_range_state(running.trust, means.ranges);
            } else {
              visit_range_state(running.ranges, kind, means.ranges);
            }
            means.mask.start_visit();
            visit_hit_mask_state(running.mask, means.mask);
          }
        } else {
          for (float& range_m : image.range_m) range_m = std::round(range_m / step_m) * step_m;
        }
        previous_m = std::move(image.range_m);
      }
    }
  }
  return means;
}

void train_all(const std::vector<TrainingDrive>& drives) {
  constexpr float kMaskStepM = 0.04F;
  fmt::print(
      "// Made by bench/train_priors.\n#include \"predict/priors.h\"\n\nnamespace pointreel {{\nnamespace "
      "{{\n\n"
      "// clang-format off\n");
  const std::pair<const char*, CodingKind> kinds[] = {{"Fast", {false, Effort::fast}},
                                                      {"Key", {false, Effort::balanced}},
                                                      {"Predicted", {true, Effort::balanced}},
                                                      {"PredictedMax", {true, Effort::max}}};
  for (const auto& [name, kind] : kinds) {
    for (std::size_t set = 0; set < kPriorSteps.size(); ++set) {
      const Means means = train(drives, kind, kPriorSteps[set]);
      means.ranges.print(fmt::format("k{}{}", name, set));
      if (kPriorSteps[set] == kMaskStepM) means.mask.print(fmt::format("k{}Mask", name));
    }
  }
  for (const auto& [name, kind] : kinds) {
    fmt::print("constexpr std::span<const std::int8_t> k{}[] = {{", name);
    for (std::size_t set = 0; set < kPriorSteps.size(); ++set)
      fmt::print("{}k{}{}", set > 0 ? ", " : "", name, set);
    fmt::print("}};\n");
  }
  fmt::print(
      "// clang-format on\n\n"
      "}}  // namespace\n\n"
      "std::span<const std::int8_t> hit_mask_priors(const CodingKind& kind) {{\n"
      "  if (kind.effort == Effort::fast) return kFastMask;\n"
      "  if (!kind.predicted) return kKeyMask;\n"
      "  return kind.effort == Effort::max ? std::span<const std::int8_t>(kPredictedMaxMask) : "
      "kPredictedMask;\n"
      "}}\n\n"
      "std::span<const std::int8_t> range_priors(const CodingKind& kind, std::size_t set) {{\n"
      "  if (kind.effort == Effort::fast) return kFast[set];\n"
      "  if (!kind.predicted) return kKey[set];\n"
      "  return kind.effort == Effort::max ? kPredictedMax[set] : kPredicted[set];\n}}\n\n"
      "}}  // namespace pointreel\n");
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  CLI::App app("Trains the priors of method mixture");
  std::vector<std::string> sweeps;
  app.add_option("SWEEP", sweeps, "Sweeps: files, folders or globs; consecutive ones of a folder")
      ->required();
  CLI11_PARSE(app, argc, argv);
  pointreel::train_all(pointreel::training_drives(sweeps));
  return 0;
}
