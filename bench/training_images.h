// Sweeps from files as the images that method `mixture` codes, for training its priors.
#pragma once

#include <filesystem>
#include <vector>

#include "predict/grid_image.h"

namespace pointreel {

struct TrainingImage {
  GridImage image;
  bool follows_previous = false;  // the same folder and sensor as the image before it
};

// One image per sweep; exits with a message where a file cannot be read or shows no sensor grid.
std::vector<TrainingImage> training_images(const std::vector<std::string>& sweeps);

}  // namespace pointreel
