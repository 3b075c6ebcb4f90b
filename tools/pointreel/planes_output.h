// The planes of sweeps as a file: JSON for programs, PLY to look at.
#pragma once

#include <filesystem>
#include <span>

#include "pointreel/planes.h"

namespace pointreel {

// By the ending of the path, .json or .ply; nothing is left of a file that fails.
// PLY: a rectangle a plane, as large as its extent, with frame and plane numbers at its corners.
Result<void> write_planes(const std::filesystem::path& path, std::span<const SweepPlanes> sweeps);

}  // namespace pointreel
