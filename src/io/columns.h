// A point cloud as a table: x, y, z and the fields are its columns. What PCD and PLY bodies have in common.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/scalar_types.h"
#include "io/text_lines.h"
#include "pointreel/point_cloud.h"
#include "pointreel/result.h"

namespace pointreel::io {

// Where a file keeps one column.
struct ColumnLayout {
  std::string name;
  ScalarType type;
  std::size_t word_index = 0;    // text: which word of a row
  std::size_t offset_bytes = 0;  // binary: of the first row's value
  std::size_t stride_bytes = 0;  // binary: from one row's value to the next
};

// Names are printable and occur once, x, y, z are there as float or double. Errors name the header line.
Result<void> check_columns(std::span<const ColumnLayout> columns, const std::string& file, std::size_t line);

// `bytes` must hold every value the layouts name.
std::vector<Field> read_binary_columns(const char* bytes, std::span<const ColumnLayout> layouts,
                                       std::size_t row_count, std::endian byte_order);

// Reads rows of exactly `words_per_row` words. The count is the file's claim and is checked here.
Result<std::vector<Field>> read_text_rows(LineReader& lines, std::span<const ColumnLayout> layouts,
                                          std::size_t words_per_row, std::uint64_t row_count,
                                          const std::string& file);

// Checks the claim that `row_count` binary rows follow at `offset`, before anything is allocated for them.
Result<void> check_rows_present(std::uint64_t row_count, std::size_t row_bytes, std::string_view bytes,
                                std::size_t offset, const std::string& file);

// What is left after the last row: a header that counts too few points would silently drop the others.
Result<void> check_no_row_left(std::size_t row_bytes, std::string_view bytes, std::size_t offset,
                               const std::string& file);
Result<void> check_no_line_left(LineReader& lines, const std::string& file);

// Takes columns that passed check_columns(); doubles in x, y, z are rounded to float.
PointCloud cloud_from_columns(std::vector<Field> columns);

// x, y, z and then the fields. invalid_argument when a name could not be read back.
Result<std::vector<Field>> columns_of(const PointCloud& cloud);

std::size_t row_bytes_of(std::span<const Field> columns);
void append_text_rows(std::string& out, std::span<const Field> columns);
void append_binary_rows(std::string& out, std::span<const Field> columns);     // row by row, little-endian
void append_binary_columns(std::string& out, std::span<const Field> columns);  // column by column

}  // namespace pointreel::io
