// Reading and writing one sweep per file: KITTI .bin, nuScenes .bin, PCD, PLY.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel {

enum class CloudFormat : std::uint8_t {
  kitti,     // .bin: float32 x, y, z, intensity, little-endian, no header
  nuscenes,  // .pcd.bin: float32 x, y, z, intensity, ring
  pcd,       // .pcd: PCL's format 0.5 to 0.7, any fields
  ply,       // .ply: element vertex with any scalar properties; other elements are skipped
};

// What becomes of a cloud in these formats, beyond values and types that are kept exactly:
// - PCD: a field of COUNT n > 1 is read as the fields name_0 to name_<n-1>, padding (`_`) is skipped. HEIGHT
//   and VIEWPOINT are not kept: points are written as one row.
// - PLY has no 64-bit integers: writing such a field is the error `unsupported`.
// - ascii keeps every number exactly (shortest text that reads back the same), of a NaN only its sign.

enum class CloudEncoding : std::uint8_t {
  ascii,              // pcd, ply
  binary,             // every format; for ply little-endian
  binary_compressed,  // pcd only (LZF)
};

std::string_view to_string(CloudFormat format);
Result<CloudFormat> parse_cloud_format(std::string_view name);  // "kitti", "nuscenes", "pcd", "ply"
std::string_view file_extension(CloudFormat format);            // ".bin", ".pcd.bin", ".pcd", ".ply"

// From the file name: .pcd.bin is nuScenes, .bin is KITTI, .pcd, .ply (case-insensitive).
Result<CloudFormat> guess_cloud_format(const std::filesystem::path& path);

// Whole file. The format is guessed when not given; a .bin whose size is no multiple of 16 but of 20 bytes is
// read as nuScenes. x, y, z may be float or double in PCD and PLY (stored as float32). Errors: io_error,
// corrupt / truncated (message names file and byte offset or line), unsupported, resource_limit (over 4 GiB).
// Points with NaN stay where they are, zero points are a valid cloud. Two fields of one name are corrupt.
Result<PointCloud> read_cloud(const std::filesystem::path& path, std::optional<CloudFormat> format = {});

// Writes to a temporary name beside `path` and renames it: no partial file is ever left under that name.
// KITTI and nuScenes hold only intensity (and ring) as float: a missing one is written as 0, other fields are
// left out. invalid_argument: a field with too few or too many values, a field name with blanks or that is
// x, y or z, an encoding that the format does not have.
Result<void> write_cloud(const std::filesystem::path& path, const PointCloud& cloud, CloudFormat format,
                         CloudEncoding encoding = CloudEncoding::binary);

// The cloud files that the user's arguments mean, in natural order within each argument (2.bin before
// 10.bin). An argument is a file, a folder (its cloud files; or those of its velodyne/, velodyne_points/data/
// or data/ subfolder when it has none itself; hidden files are no cloud files), or a glob pattern (* ? [..])
// of files. Error naming the argument when one matches nothing.
Result<std::vector<std::filesystem::path>> expand_inputs(std::span<const std::string> arguments);

// True when a sorts before b with digit runs compared as numbers.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace pointreel
