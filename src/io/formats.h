// One pair of functions per format, on bytes in memory. `file` only names the file in errors.
#pragma once

#include <string>
#include <string_view>

#include "pointreel/io.h"

namespace pointreel::io {

Result<PointCloud> parse_kitti(std::string_view bytes, const std::string& file);
Result<PointCloud> parse_nuscenes(std::string_view bytes, const std::string& file);
Result<PointCloud> parse_pcd(std::string_view bytes, const std::string& file);
Result<PointCloud> parse_ply(std::string_view bytes, const std::string& file);

// The cloud's fields must have as many values as it has points.
Result<std::string> serialize_kitti(const PointCloud& cloud, CloudEncoding encoding);
Result<std::string> serialize_nuscenes(const PointCloud& cloud, CloudEncoding encoding);
Result<std::string> serialize_pcd(const PointCloud& cloud, CloudEncoding encoding);
Result<std::string> serialize_ply(const PointCloud& cloud, CloudEncoding encoding);

// KITTI and nuScenes share the ending .bin and have no header: only the size can tell them apart.
bool is_nuscenes_size(std::size_t size_bytes);

}  // namespace pointreel::io
