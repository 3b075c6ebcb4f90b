// KITTI and nuScenes: records of 4 or 5 little-endian floats and nothing else.
#include <array>
#include <span>
#include <variant>

#include "io/file_error.h"
#include "io/formats.h"
#include "io/scalar_types.h"

namespace pointreel::io {
namespace {

constexpr std::array<std::string_view, 1> kitti_fields = {"intensity"};
constexpr std::array<std::string_view, 2> nuscenes_fields = {"intensity", "ring"};

using FieldNames = std::span<const std::string_view>;

constexpr std::size_t record_bytes(FieldNames names) {
  return (3 + names.size()) * sizeof(float);
}

Result<PointCloud> parse_records(std::string_view bytes, const std::string& file, FieldNames names) {
  const std::size_t stride_bytes = record_bytes(names);
  if (bytes.size() % stride_bytes != 0) {
    return error_at_byte(ErrorCode::truncated, file, bytes.size() - bytes.size() % stride_bytes,
                         "only " + std::to_string(bytes.size() % stride_bytes) + " of a point's " +
                             std::to_string(stride_bytes) + " bytes are left");
  }
  const std::size_t count = bytes.size() / stride_bytes;
  const auto value = [&](std::size_t i, std::size_t column) {
    return load<float>(bytes.data() + i * stride_bytes + column * sizeof(float), std::endian::little);
  };
  PointCloud cloud;
  cloud.positions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) cloud.positions.push_back({value(i, 0), value(i, 1), value(i, 2)});
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = value(i, 3 + k);
    cloud.fields.push_back({std::string(names[k]), std::move(values)});
  }
  return cloud;
}

Result<std::string> serialize_records(const PointCloud& cloud, CloudEncoding encoding, FieldNames names) {
  if (encoding != CloudEncoding::binary) {
    return Error{ErrorCode::invalid_argument, "KITTI and nuScenes files are always binary"};
  }
  const std::size_t stride_bytes = record_bytes(names);
  std::string bytes(cloud.size() * stride_bytes, '\0');  // a missing field stays 0, which is all zero bits
  const auto put = [&](std::size_t i, std::size_t column, float value) {
    store_little_endian(bytes.data() + i * stride_bytes + column * sizeof(float), value);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    put(i, 0, cloud.positions[i].x);
    put(i, 1, cloud.positions[i].y);
    put(i, 2, cloud.positions[i].z);
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Field* field = cloud.find_field(names[k]);
    if (field == nullptr) continue;
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < values.size(); ++i) put(i, 3 + k, static_cast<float>(values[i]));
        },
        field->values);
  }
  return bytes;
}

}  // namespace

bool is_nuscenes_size(std::size_t size_bytes) {
  return size_bytes % record_bytes(kitti_fields) != 0 && size_bytes % record_bytes(nuscenes_fields) == 0;
}

Result<PointCloud> parse_kitti(std::string_view bytes, const std::string& file) {
  return parse_records(bytes, file, kitti_fields);
}

Result<PointCloud> parse_nuscenes(std::string_view bytes, const std::string& file) {
  return parse_records(bytes, file, nuscenes_fields);
}

Result<std::string> serialize_kitti(const PointCloud& cloud, CloudEncoding encoding) {
  return serialize_records(cloud, encoding, kitti_fields);
}

Result<std::string> serialize_nuscenes(const PointCloud& cloud, CloudEncoding encoding) {
  return serialize_records(cloud, encoding, nuscenes_fields);
}

}  // namespace pointreel::io
