#include "io/columns.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/file_error.h"

namespace pointreel::io {
namespace {

constexpr std::array<std::string_view, 3> axis_names = {"x", "y", "z"};
constexpr std::array<float Point3f::*, 3> axes = {&Point3f::x, &Point3f::y, &Point3f::z};

bool is_axis(std::string_view name) {
  return std::find(axis_names.begin(), axis_names.end(), name) != axis_names.end();
}

// Headers separate names by blanks and lines.
bool is_writable_name(std::string_view name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
  });
}

// A name that occurs more than once, or nullptr.
const std::string* find_duplicate(std::vector<const std::string*> names) {
  const auto less = [](const std::string* a, const std::string* b) { return *a < *b; };
  const auto equal = [](const std::string* a, const std::string* b) { return *a == *b; };
  std::sort(names.begin(), names.end(), less);
  const auto it = std::adjacent_find(names.begin(), names.end(), equal);
  return it == names.end() ? nullptr : *it;
}

template <class Named>
std::vector<const std::string*> names_of(std::span<const Named> columns) {
  std::vector<const std::string*> names;
  for (const auto& column : columns) names.push_back(&column.name);
  return names;
}

// A row takes at least one digit and one blank or line end per word; the last line end may be missing.
bool rows_fit(std::uint64_t row_count, std::size_t words_per_row, std::size_t bytes_left) {
  return row_count <= (bytes_left + 1) / (2 * words_per_row);
}

}  // namespace

Result<void> check_columns(std::span<const ColumnLayout> columns, const std::string& file, std::size_t line) {
  for (const ColumnLayout& column : columns) {
    if (!is_writable_name(column.name)) {
      return error_at_line(ErrorCode::corrupt, file, line,
                           "field name " + in_quotes(column.name) + " is not text");
    }
    if (is_axis(column.name) && !is_float(column.type)) {
      return error_at_line(ErrorCode::unsupported, file, line,
                           "field " + in_quotes(column.name) + " is neither float nor double");
    }
  }
  if (const std::string* duplicate = find_duplicate(names_of(columns))) {
    return error_at_line(ErrorCode::corrupt, file, line,
                         "field " + in_quotes(*duplicate) + " is there twice");
  }
  for (const std::string_view axis : axis_names) {
    if (std::none_of(columns.begin(), columns.end(),
                     [&](const auto& column) { return column.name == axis; })) {
      return error_at_line(ErrorCode::unsupported, file, line, "there is no field " + in_quotes(axis));
    }
  }
  return {};
}

std::vector<Field> read_binary_columns(const char* bytes, std::span<const ColumnLayout> layouts,
                                       std::size_t row_count, std::endian byte_order) {
  std::vector<Field> columns;
  columns.reserve(layouts.size());
  for (const ColumnLayout& layout : layouts) {
    FieldValues values = make_values(layout.type, row_count);
    std::visit(
        [&]<class T>(std::vector<T>& column) {
          for (std::size_t row = 0; row < row_count; ++row) {
            column[row] = load<T>(bytes + layout.offset_bytes + row * layout.stride_bytes, byte_order);
          }
        },
        values);
    columns.push_back({layout.name, std::move(values)});
  }
  return columns;
}

Result<std::vector<Field>> read_text_rows(LineReader& lines, std::span<const ColumnLayout> layouts,
                                          std::size_t words_per_row, std::uint64_t row_count,
                                          const std::string& file) {
  if (!rows_fit(row_count, words_per_row, lines.bytes_left())) {
    return error_at_byte(ErrorCode::truncated, file, lines.offset(),
                         "the header claims " + std::to_string(row_count) + " points, but only " +
                             std::to_string(lines.bytes_left()) + " bytes follow");
  }
  std::vector<Field> columns;
  columns.reserve(layouts.size());
  for (const ColumnLayout& layout : layouts) {
    columns.push_back({layout.name, make_values(layout.type, row_count)});
  }

  std::vector<std::string_view> words;
  for (std::size_t row = 0; row < row_count; ++row) {
    if (!lines.next_words(words)) {
      return error_at_line(
          ErrorCode::truncated, file, lines.line_number(),
          "the file ends after " + std::to_string(row) + " of " + std::to_string(row_count) + " points");
    }
    if (words.size() != words_per_row) {
      return error_at_line(
          ErrorCode::corrupt, file, lines.line_number(),
          "has " + std::to_string(words.size()) + " values instead of " + std::to_string(words_per_row));
    }
    for (std::size_t i = 0; i < layouts.size(); ++i) {
      const std::string_view word = words[layouts[i].word_index];
      const bool is_number = std::visit(
          [&]<class T>(std::vector<T>& column) {
            const auto value = parse_number<T>(word);
            if (value) column[row] = *value;
            return value.has_value();
          },
          columns[i].values);
      if (!is_number) {
        return error_at_line(
            ErrorCode::corrupt, file, lines.line_number(),
            in_quotes(word) + " is no value that field " + in_quotes(layouts[i].name) + " can hold");
      }
    }
  }
  return columns;
}

Result<void> check_rows_present(std::uint64_t row_count, std::size_t row_bytes, std::string_view bytes,
                                std::size_t offset, const std::string& file) {
  const std::size_t bytes_left = bytes.size() - offset;
  if (row_bytes == 0 || row_count <= bytes_left / row_bytes) return {};
  return error_at_byte(ErrorCode::truncated, file, offset,
                       "the header claims " + std::to_string(row_count) + " rows of " +
                           std::to_string(row_bytes) + " bytes, but only " + std::to_string(bytes_left) +
                           " bytes follow");
}

Result<void> check_no_row_left(std::size_t row_bytes, std::string_view bytes, std::size_t offset,
                               const std::string& file) {
  // Less than a point, such as a final line end, does no harm.
  if (bytes.size() - offset < row_bytes) return {};
  return error_at_byte(ErrorCode::corrupt, file, offset,
                       std::to_string(bytes.size() - offset) +
                           " bytes follow the last point, so the header counts too few points");
}

Result<void> check_no_line_left(LineReader& lines, const std::string& file) {
  std::vector<std::string_view> words;
  if (!lines.next_words(words)) return {};
  return error_at_line(ErrorCode::corrupt, file, lines.line_number(),
                       "follows the last row, so the header counts too few points");
}

PointCloud cloud_from_columns(std::vector<Field> columns) {
  PointCloud cloud;
  cloud.positions.resize(columns.front().size());
  for (Field& column : columns) {
    const auto axis = std::find(axis_names.begin(), axis_names.end(), column.name);
    if (axis == axis_names.end()) {
      cloud.fields.push_back(std::move(column));
      continue;
    }
    const auto member = axes[static_cast<std::size_t>(axis - axis_names.begin())];
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = 0; i < values.size(); ++i) {
            cloud.positions[i].*member = static_cast<float>(values[i]);  // beyond float: infinity
          }
        },
        column.values);
  }
  return cloud;
}

Result<std::vector<Field>> columns_of(const PointCloud& cloud) {
  for (const Field& field : cloud.fields) {
    if (!is_writable_name(field.name) || is_axis(field.name)) {
      return Error{ErrorCode::invalid_argument, "a field cannot be named " + in_quotes(field.name)};
    }
  }
  if (const std::string* duplicate = find_duplicate(names_of(std::span<const Field>(cloud.fields)))) {
    return Error{ErrorCode::invalid_argument, "two fields are named " + in_quotes(*duplicate)};
  }
  std::vector<Field> columns;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    std::vector<float> values;
    values.reserve(cloud.size());
    for (const Point3f& point : cloud.positions) values.push_back(point.*axes[axis]);
    columns.push_back({std::string(axis_names[axis]), std::move(values)});
  }
  columns.insert(columns.end(), cloud.fields.begin(), cloud.fields.end());
  return columns;
}

std::size_t row_bytes_of(std::span<const Field> columns) {
  std::size_t bytes = 0;
  for (const Field& column : columns) bytes += size_of(scalar_type_of(column.values));
  return bytes;
}

void append_text_rows(std::string& out, std::span<const Field> columns) {
  const std::size_t row_count = columns.front().size();
  for (std::size_t row = 0; row < row_count; ++row) {
    for (const Field& column : columns) {
      std::visit([&](const auto& values) { append_number(out, values[row]); }, column.values);
      out += ' ';
    }
    out.back() = '\n';
  }
}

void append_binary_rows(std::string& out, std::span<const Field> columns) {
  const std::size_t row_bytes = row_bytes_of(columns);
  std::size_t offset = out.size();
  out.resize(out.size() + columns.front().size() * row_bytes);
  for (const Field& column : columns) {
    std::visit(
        [&](const auto& values) {
          char* target = out.data() + offset;
          for (const auto value : values) {
            store_little_endian(target, value);
            target += row_bytes;
          }
        },
        column.values);
    offset += size_of(scalar_type_of(column.values));
  }
}

void append_binary_columns(std::string& out, std::span<const Field> columns) {
  for (const Field& column : columns) append_binary_rows(out, std::span(&column, 1));
}

}  // namespace pointreel::io
