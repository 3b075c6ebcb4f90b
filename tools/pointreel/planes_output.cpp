#include "pointreel/planes_output.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace pointreel {
namespace {

nlohmann::json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::string json_of(std::span<const SweepPlanes> sweeps) {
  nlohmann::json json = {{"sweeps", nlohmann::json::array()}};
  for (const SweepPlanes& sweep : sweeps) {
    nlohmann::json planes = nlohmann::json::array();
    for (const SweepPlane& plane : sweep.planes) {
      planes.push_back({{"normal", to_json(plane.normal)},
                        {"distance_m", plane.distance_m},
                        {"reused", plane.reused},
                        {"tiles", plane.tiles},
                        {"cells", plane.cells},
                        {"center_m", to_json(plane.center_m)},
                        {"long_axis", to_json(plane.long_axis)},
                        {"short_axis", to_json(plane.short_axis)},
                        {"length_m", plane.length_m},
                        {"width_m", plane.width_m}});
    }
    json["sweeps"].push_back({{"frame", sweep.frame}, {"planes", planes}});
  }
  return json.dump(1) + "\n";
}

template <class T>
void append(std::string& bytes, T value) {
  std::array<char, sizeof value> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  bytes.append(raw.data(), raw.size());
}

std::string ply_of(std::span<const SweepPlanes> sweeps) {
  std::size_t planes = 0;
  for (const SweepPlanes& sweep : sweeps) planes += sweep.planes.size();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uint frame\n"
      "property uint plane\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      4 * planes, planes);
  for (const SweepPlanes& sweep : sweeps) {
    for (std::size_t i = 0; i < sweep.planes.size(); ++i) {
      const SweepPlane& plane = sweep.planes[i];
      for (const auto& [along, across] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        const Eigen::Vector3d corner_m = plane.center_m + along * plane.length_m * plane.long_axis +
                                         across * plane.width_m * plane.short_axis;
        for (const Eigen::Vector3d& v : {corner_m, plane.normal}) {
          for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]));
        }
        append(bytes, sweep.frame);
        append(bytes, static_cast<std::uint32_t>(i));
      }
    }
  }
  for (std::uint32_t face = 0; face < planes; ++face) {
    append(bytes, std::uint8_t{4});
    for (std::uint32_t corner = 0; corner < 4; ++corner) append(bytes, 4 * face + corner);
  }
  return bytes;
}

}  // namespace

Result<void> write_planes(const std::filesystem::path& path, std::span<const SweepPlanes> sweeps) {
  const std::string bytes = path.extension() == ".ply" ? ply_of(sweeps) : json_of(sweeps);
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    return Error{ErrorCode::io_error, path.string() + ": cannot write"};
  }
  return {};
}

}  // namespace pointreel
