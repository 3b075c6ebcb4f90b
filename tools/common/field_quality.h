// How far decoded field values are from the originals.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pointreel/codec.h"

namespace pointreel {

struct FieldDifference {
  double max = 0;     // in the field's own unit; infinite where only one of the two is a number
  bool exact = true;  // every value to the bit
};

using FieldDifferences = std::map<std::string, FieldDifference>;

// Adds the fields that `decoded` has. Error: one that the original does not have, or has in another type.
// `pairs` as pair_points() gives them.
Result<void> compare_fields(const PointCloud& original, const DecodedSweep& decoded,
                            const std::vector<std::int64_t>& pairs, FieldDifferences& differences);

}  // namespace pointreel
