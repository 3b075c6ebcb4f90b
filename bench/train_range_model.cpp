// Trains the priors of the range model.
//
//   train_range_model SWEEP... > src/predict/range_priors.cpp
//
// For each size of the step all sweeps are coded twice with a state that is never reset; the priors are the
// mean of what it was at the ends of the bands in the second pass.
#include <CLI/CLI.hpp>
#include <cmath>

#include "predict/band_coding.h"
#include "predict/range_priors.h"
#include "prior_tables.h"
#include "training_images.h"

namespace pointreel {
namespace {

template <std::size_t kInputs, std::size_t kSets>
std::vector<double> weights_of(const std::array<BitMixer<kInputs>, kSets>& mixers) {
  std::vector<double> weights;
  for (const auto& mixer : mixers) {
    for (std::size_t input = 0; input < kInputs; ++input) weights.push_back(prior_weight(mixer, input));
  }
  return weights;
}

// Sums over the ends of bands.
class StateMean {
 public:
  void add(const RangeModelState& state) {
    ++count_;
    std::size_t next = 0;
    const auto put = [&](double value) {
      if (next == numbers_.size()) numbers_.push_back(0);
      numbers_[next++] += value;
    };
    for (const auto& at : state.mixture.classes) {
      double middle = 0;
      for (const float weight : at.weight) middle += std::log2(weight) / kExperts;
      for (const float weight : at.weight) put(8 * (std::log2(weight) - middle));
    }
    for (const auto& at : state.mixture.classes) {
      for (const float inverse_scale : at.inverse_scale) put(8 * std::log2(inverse_scale));
    }
    for (const double w : weights_of(state.steps.zero_mixers)) put(w);
    for (const double w : weights_of(state.steps.sign_mixers)) put(w);
    for (const double w : weights_of(state.steps.more_mixers)) put(w);
    last_ = state;
  }

  void print() const {
    std::size_t next = 0;
    const auto take = [&](std::size_t count, int least, int most) {
      std::vector<int> values;
      for (std::size_t i = 0; i < count; ++i) {
        values.push_back(std::clamp(static_cast<int>(std::lround(numbers_[next++] / count_)), least, most));
      }
      return values;
    };
    const auto part = [](const std::vector<int>& values) {
      fmt::print("    {{\n");
      print_list(values);
      fmt::print("    }},\n");
    };
    const StepModels& steps = last_.steps;
    fmt::print("  RangePriors{{\n");
    part(take(kErrorClasses * kExperts, -127, 127));
    part(take(kErrorClasses * kExperts, -127, 127));
    part(bytes_of(steps.zero_by_activity));
    part(bytes_by_availability(steps.zero_by_row));
    part(bytes_by_availability(steps.sign_by_row));
    part(bytes_of(steps.sign_by_signs));
    part(bytes_of(steps.more_by_error));
    part(take(3 * steps.zero_mixers.size(), -4096, 4096));
    part(take(3 * steps.sign_mixers.size(), -4096, 4096));
    part(take(2 * steps.more_mixers.size(), -4096, 4096));
    fmt::print("  }},\n");
  }

 private:
  template <std::size_t kBits>
  static std::vector<int> bytes_of(const std::array<CountedBit, kBits>& bits) {
    std::vector<int> bytes;
    for (const CountedBit& bit : bits) bytes.push_back(prior_byte(bit.p_one(), bit.count()));
    return bytes;
  }
  // The mean over all rows that were seen, so that the priors do not know one sensor's rows.
  template <std::size_t kBits>
  static std::vector<int> bytes_by_availability(const std::array<CountedBit, kBits>& bits) {
    std::vector<int> bytes;
    for (std::size_t availability = 0; availability < 4; ++availability) {
      double sum = 0, seen = 0;
      for (std::size_t i = availability; i < kBits; i += 4) {
        sum += static_cast<double>(bits[i].p_one()) * bits[i].count();
        seen += bits[i].count();
      }
      const auto p_one = seen > 0 ? static_cast<Probability16>(sum / seen) : 32768u;
      bytes.push_back(prior_byte(p_one, seen > 0 ? 30 : 0));  // rows differ: worth ten bits
    }
    return bytes;
  }

  double count_ = 0;
  std::vector<double> numbers_;
  RangeModelState last_;
};

void train(const std::vector<TrainingImage>& images, float step_m) {
  RangeModelState running;
  StateMean mean;
  for (const bool counts : {false, true}) {
    for (const TrainingImage& training : images) {
      GridImage image = training.image;
      for (const Band& band : bands_of(image.rows, image.columns)) {
        const RangeQuantiser quantiser{step_m, {}};
        BandState state = BandState::from_priors(quantiser, band);
        state.ranges = running;
        encode_band(quantiser, band, image, state);
        running = state.ranges;
        if (counts) mean.add(running);
      }
    }
  }
  mean.print();
}

}  // namespace
}  // namespace pointreel

int main(int argc, char** argv) {
  using namespace pointreel;
  CLI::App app("Trains the priors of the range model");
  std::vector<std::string> sweeps;
  app.add_option("SWEEP", sweeps, "Sweeps: files, folders or globs")->required();
  CLI11_PARSE(app, argc, argv);
  const auto images = training_images(sweeps);
  fmt::print(
      "// Made by bench/train_range_model.\n#include \"predict/range_priors.h\"\n\nnamespace pointreel {{\n\n"
      "// clang-format off\nconst std::array<RangePriors, kPriorSteps.size()> kRangePriors = {{\n");
  for (const float step_m : kPriorSteps) train(images, step_m);
  fmt::print("}};\n// clang-format on\n\n}}  // namespace pointreel\n");
  return 0;
}
