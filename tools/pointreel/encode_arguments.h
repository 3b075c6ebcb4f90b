// The command line of `encode`, and the codec's options that it means.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

struct EncodeArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string method = "mixture";
  std::string grid = "sensor";  // of method planes
  std::optional<int> group;     // none: the method's own default
  // on the sensor's grid
  std::string max_error = "2cm";
  std::string fields = "all";
  std::string effort = "balanced";
  bool no_temporal = false;
  // planes on the uniform grid
  std::string threshold = "0.1";
  std::string azimuth_step = "0.18deg";
  std::string elevation_step = "0.45deg";
  int tile = 4;
  std::string residual_step = "auto";
  // both
  std::string motion = "auto";
  std::string poses;
  std::string imu;

  bool follow = false;
  std::optional<double> idle_s;
  int threads = 0;
  bool force = false;
  bool json = false;

  // Options that go with one grid only, and the one that chooses it.
  std::vector<const CLI::Option*> sensor_only, uniform_only;
  const CLI::Option* grid_option = nullptr;
};

// Sweeps are taken as they arrive, instead of from files that are all there.
bool is_live(const EncodeArguments& arguments);

void add_encode_arguments(CLI::App& verb, EncodeArguments& arguments);

// Error naming the option that is wrong by itself, or with the method.
Result<EncoderOptions> encoder_options(const EncodeArguments& arguments);

}  // namespace pointreel
