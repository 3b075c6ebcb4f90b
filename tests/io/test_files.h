// Folders, files and clouds for the tests of src/io.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "pointreel/io.h"

namespace pointreel {

// A folder of its own, gone at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "pointreel_io_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::filesystem::path& name, std::string_view bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The bytes of plain values, for building binary bodies by hand.
template <class... T>
std::string bytes_of(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
  return bytes;
}

enum class NanPayload : std::uint8_t { exact, any };

template <class T>
bool same_value(T a, T b, NanPayload nan_payload) {
  if constexpr (std::is_floating_point_v<T>) {
    if (nan_payload == NanPayload::any && std::isnan(a) && std::isnan(b)) return true;
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
  } else {
    return a == b;
  }
}

inline bool same_values(const FieldValues& a, const FieldValues& b, NanPayload nan_payload) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const auto& others = std::get<std::vector<T>>(b);
        return std::equal(values.begin(), values.end(), others.begin(), others.end(),
                          [&](T x, T y) { return same_value(x, y, nan_payload); });
      },
      a);
}

// Bit for bit, as == on floats would take -0 for 0 and no NaN for itself.
inline bool same_cloud(const PointCloud& a, const PointCloud& b, NanPayload nan_payload = NanPayload::exact) {
  const auto same_point = [&](const Point3f& p, const Point3f& q) {
    return same_value(p.x, q.x, nan_payload) && same_value(p.y, q.y, nan_payload) &&
           same_value(p.z, q.z, nan_payload);
  };
  const auto same_field = [&](const Field& f, const Field& g) {
    return f.name == g.name && same_values(f.values, g.values, nan_payload);
  };
  return std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(),
                    same_point) &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same_field);
}

// The values of a field that must be there and be of type T.
template <class T>
std::vector<T> values_of(const PointCloud& cloud, std::string_view name) {
  const Field* field = cloud.find_field(name);
  const auto* values = field == nullptr ? nullptr : std::get_if<std::vector<T>>(&field->values);
  if (values == nullptr) {
    ADD_FAILURE() << "no field " << name << " of the expected type";
    return {};
  }
  return *values;
}

// Checks the code and that the message holds every one of `parts`.
template <class T>
void expect_error(const Result<T>& result, ErrorCode code, std::initializer_list<std::string> parts) {
  ASSERT_FALSE(result);
  EXPECT_EQ(to_string(result.error().code), to_string(code)) << result.error().message;
  for (const std::string& part : parts) {
    EXPECT_NE(result.error().message.find(part), std::string::npos)
        << "no '" << part << "' in: " << result.error().message;
  }
}

}  // namespace pointreel
