// Which format a file has, and the way from a file to a cloud and back.
#include <algorithm>
#include <array>
#include <cctype>
#include <new>

#include "io/file_bytes.h"
#include "io/file_error.h"
#include "io/formats.h"
#include "pointreel/io.h"

namespace pointreel {
namespace {

struct Format {
  CloudFormat format;
  std::string_view name;
  std::string_view extension;
  Result<PointCloud> (*parse)(std::string_view bytes, const std::string& file);
  Result<std::string> (*serialize)(const PointCloud& cloud, CloudEncoding encoding);
};

// In the order of CloudFormat.
constexpr std::array<Format, 4> formats = {{
    {CloudFormat::kitti, "kitti", ".bin", io::parse_kitti, io::serialize_kitti},
    {CloudFormat::nuscenes, "nuscenes", ".pcd.bin", io::parse_nuscenes, io::serialize_nuscenes},
    {CloudFormat::pcd, "pcd", ".pcd", io::parse_pcd, io::serialize_pcd},
    {CloudFormat::ply, "ply", ".ply", io::parse_ply, io::serialize_ply},
}};

const Format& description_of(CloudFormat format) {
  return formats[static_cast<std::size_t>(format)];
}

Error out_of_memory(const std::filesystem::path& path) {
  return {ErrorCode::resource_limit, path.string() + ": there is not enough memory for this cloud"};
}

Result<PointCloud> read(const std::filesystem::path& path, std::optional<CloudFormat> format) {
  const bool is_guessed = !format;
  if (is_guessed) {
    const auto guess = guess_cloud_format(path);
    if (!guess) return guess.error();
    format = *guess;
  }
  const auto bytes = io::read_file(path);
  if (!bytes) return bytes.error();
  if (is_guessed && format == CloudFormat::kitti && io::is_nuscenes_size(bytes->size())) {
    format = CloudFormat::nuscenes;
  }
  return description_of(*format).parse(*bytes, path.string());
}

Result<void> write(const std::filesystem::path& path, const PointCloud& cloud, CloudFormat format,
                   CloudEncoding encoding) {
  for (const Field& field : cloud.fields) {
    if (field.size() != cloud.size()) {
      return Error{ErrorCode::invalid_argument, path.string() + ": cannot write field " +
                                                    io::in_quotes(field.name) + " with " +
                                                    std::to_string(field.size()) + " values for " +
                                                    std::to_string(cloud.size()) + " points"};
    }
  }
  const auto bytes = description_of(format).serialize(cloud, encoding);
  if (!bytes) return Error{bytes.error().code, path.string() + ": cannot write: " + bytes.error().message};
  return io::write_file_atomically(path, *bytes);
}

}  // namespace

std::string_view to_string(CloudFormat format) {
  return description_of(format).name;
}

std::string_view file_extension(CloudFormat format) {
  return description_of(format).extension;
}

Result<CloudFormat> parse_cloud_format(std::string_view name) {
  for (const Format& format : formats) {
    if (name == format.name) return format.format;
  }
  return Error{ErrorCode::invalid_argument,
               "cloud format " + io::in_quotes(name) + " is none of kitti, nuscenes, pcd, ply"};
}

Result<CloudFormat> guess_cloud_format(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const Format* best = nullptr;  // .pcd.bin is also a .bin: the longer ending wins
  for (const Format& format : formats) {
    if (!name.ends_with(format.extension)) continue;
    if (best == nullptr || format.extension.size() > best->extension.size()) best = &format;
  }
  if (best != nullptr) return best->format;
  return Error{ErrorCode::unsupported,
               path.string() + ": the name ends in none of .bin, .pcd.bin, .pcd, .ply"};
}

Result<PointCloud> read_cloud(const std::filesystem::path& path, std::optional<CloudFormat> format) {
  try {
    return read(path, format);
  } catch (const std::bad_alloc&) {
    return out_of_memory(path);
  }
}

Result<void> write_cloud(const std::filesystem::path& path, const PointCloud& cloud, CloudFormat format,
                         CloudEncoding encoding) {
  try {
    return write(path, cloud, format, encoding);
  } catch (const std::bad_alloc&) {
    return out_of_memory(path);
  }
}

}  // namespace pointreel
