#include "predict/hit_mask.h"
