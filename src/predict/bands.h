// Bands: the rows of an image that are coded together, without a look at the others, so that a sweep can be
// coded by several threads. They are a property of the stream, not of the machine.
#pragma once

#include <vector>

#include "predict/grid_image.h"

namespace pointreel {

struct Band {
  int first_row = 0;
  int rows = 0;
};

// Bands of about 70,000 cells, fewer of which learn too little, and more leave threads idle; whole blocks of
// the wavefront, and so divided that each takes about the same time. `step_m`: the quantiser's.
std::vector<Band> choose_bands(const GridImage& image, float step_m, int threads = 1);

}  // namespace pointreel
