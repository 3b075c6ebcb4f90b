#include "io/pcd_header.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include "io/file_error.h"
#include "io/text_lines.h"

namespace pointreel::io {
namespace {

// PCL's widest points take some 3 KiB. Keeps sums and products of claimed sizes far from overflow, and the
// number of columns small that a header can ask for without paying for them in bytes.
constexpr std::size_t max_row_bytes = std::size_t{64} << 10;

// COLUMNS is an old name of FIELDS.
constexpr std::array<std::string_view, 11> keywords = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                       "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                       "VIEWPOINT", "POINTS", "DATA"};

// The words after a keyword. A keyword that is not there is an entry without words at the header's last line.
struct Entry {
  std::size_t line = 0;
  std::vector<std::string_view> words;
};

struct Entries {
  std::map<std::string_view, Entry> by_keyword;
  std::size_t last_line = 0;

  Entry operator[](std::string_view keyword) const {
    const auto it = by_keyword.find(keyword);
    return it == by_keyword.end() ? Entry{last_line, {}} : it->second;
  }
  bool has(std::string_view keyword) const { return by_keyword.contains(keyword); }
};

Result<Entries> read_entries(LineReader& lines, const std::string& file) {
  Entries entries;
  std::vector<std::string_view> words;
  while (lines.next_words(words)) {
    if (words[0].starts_with('#')) continue;
    const auto keyword = std::find(keywords.begin(), keywords.end(), words[0]);
    if (keyword == keywords.end()) {
      return error_at_line(ErrorCode::corrupt, file, lines.line_number(),
                           in_quotes(words[0]) + " is no keyword of a PCD header");
    }
    entries.last_line = lines.line_number();
    entries.by_keyword[*keyword == "COLUMNS" ? "FIELDS" : *keyword] = {lines.line_number(),
                                                                       {words.begin() + 1, words.end()}};
    if (*keyword == "DATA") return entries;
  }
  return error_at_line(ErrorCode::truncated, file, lines.line_number(), "the file ends before the DATA line");
}

std::optional<ScalarType> scalar_type(std::string_view type, std::size_t bytes) {
  struct Row {
    std::string_view type;
    std::size_t bytes;
    ScalarType scalar;
  };
  constexpr std::array<Row, 10> table = {{
      {"I", 1, ScalarType::int8},
      {"I", 2, ScalarType::int16},
      {"I", 4, ScalarType::int32},
      {"I", 8, ScalarType::int64},
      {"U", 1, ScalarType::uint8},
      {"U", 2, ScalarType::uint16},
      {"U", 4, ScalarType::uint32},
      {"U", 8, ScalarType::uint64},
      {"F", 4, ScalarType::float32},
      {"F", 8, ScalarType::float64},
  }};
  const auto it = std::find_if(table.begin(), table.end(),
                               [&](const Row& row) { return row.type == type && row.bytes == bytes; });
  if (it == table.end()) return std::nullopt;
  return it->scalar;
}

// FIELDS, SIZE, TYPE and COUNT (all 1 when absent).
Result<std::vector<PcdField>> read_fields(const Entries& entries, const std::string& file) {
  const Entry names = entries["FIELDS"];
  const Entry sizes = entries["SIZE"];
  const Entry types = entries["TYPE"];
  const Entry counts = entries["COUNT"];
  for (const Entry* entry : {&sizes, &types, &counts}) {
    if (entry == &counts && !entries.has("COUNT")) continue;
    if (entry->words.size() != names.words.size()) {
      return error_at_line(ErrorCode::corrupt, file, entry->line,
                           "the header has " + std::to_string(names.words.size()) + " FIELDS but " +
                               std::to_string(sizes.words.size()) + " SIZE, " +
                               std::to_string(types.words.size()) + " TYPE and " +
                               std::to_string(counts.words.size()) + " COUNT values");
    }
  }

  std::vector<PcdField> fields;
  std::size_t row_bytes = 0;
  for (std::size_t i = 0; i < names.words.size(); ++i) {
    const auto value_bytes = parse_number<std::size_t>(sizes.words[i]);
    if (!value_bytes || *value_bytes == 0) {
      return error_at_line(ErrorCode::corrupt, file, sizes.line, in_quotes(sizes.words[i]) + " is no SIZE");
    }
    const auto count = counts.words.empty() ? std::size_t{1} : parse_number<std::size_t>(counts.words[i]);
    if (!count || *count == 0) {
      return error_at_line(ErrorCode::corrupt, file, counts.line,
                           in_quotes(counts.words[i]) + " is no COUNT");
    }
    const auto type = scalar_type(types.words[i], *value_bytes);
    const bool is_padding = names.words[i] == "_";
    if (!type && !is_padding) {
      return error_at_line(ErrorCode::unsupported, file, types.line,
                           "field " + in_quotes(names.words[i]) + " has the unknown TYPE " +
                               in_quotes(types.words[i]) + " with SIZE " + std::to_string(*value_bytes));
    }
    if (*value_bytes > max_row_bytes || *count > (max_row_bytes - row_bytes) / *value_bytes) {
      return error_at_line(
          ErrorCode::resource_limit, file, names.line,
          "one point takes more than the limit of " + std::to_string(max_row_bytes) + " bytes");
    }
    fields.push_back({std::string(names.words[i]), type.value_or(ScalarType::uint8), *value_bytes, *count});
    row_bytes += fields.back().bytes();
  }
  return fields;
}

// WIDTH x HEIGHT or POINTS, which must agree when both are there.
Result<std::uint64_t> read_point_count(const Entries& entries, const std::string& file) {
  std::array<std::uint64_t, 3> values = {1, 1, 1};
  constexpr std::array<std::string_view, 3> names = {"WIDTH", "HEIGHT", "POINTS"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!entries.has(names[i])) continue;
    const Entry entry = entries[names[i]];
    const auto value = entry.words.size() == 1 ? parse_number<std::uint64_t>(entry.words[0]) : std::nullopt;
    if (!value) {
      return error_at_line(ErrorCode::corrupt, file, entry.line,
                           "the value of " + std::string(names[i]) + " is no whole number");
    }
    values[i] = *value;
  }
  const auto [width, height, points] = values;
  if (!entries.has("WIDTH") && !entries.has("POINTS")) {
    return error_at_line(ErrorCode::corrupt, file, entries.last_line,
                         "the header has neither WIDTH nor POINTS");
  }
  if (!entries.has("WIDTH")) return points;
  const bool overflows = height != 0 && width > std::numeric_limits<std::uint64_t>::max() / height;
  if (overflows || (entries.has("POINTS") && points != width * height)) {
    return error_at_line(ErrorCode::corrupt, file, entries[overflows ? "WIDTH" : "POINTS"].line,
                         "WIDTH " + std::to_string(width) + " times HEIGHT " + std::to_string(height) +
                             " are not the number of POINTS");
  }
  return width * height;
}

Result<CloudEncoding> read_encoding(const Entries& entries, const std::string& file) {
  const Entry data = entries["DATA"];
  const std::string_view word = data.words.size() == 1 ? data.words[0] : "";
  if (word == "ascii") return CloudEncoding::ascii;
  if (word == "binary") return CloudEncoding::binary;
  if (word == "binary_compressed") return CloudEncoding::binary_compressed;
  return error_at_line(ErrorCode::unsupported, file, data.line,
                       "DATA is " + in_quotes(word) + " and not ascii, binary or binary_compressed");
}

// 0.5 to 0.7 differ only in lines that may be missing. Old writers leave the 0 away.
Result<void> check_version(const Entries& entries, const std::string& file) {
  constexpr std::array<std::string_view, 6> known = {"0.7", ".7", "0.6", ".6", "0.5", ".5"};
  if (!entries.has("VERSION")) return {};
  const Entry version = entries["VERSION"];
  const std::string_view word = version.words.size() == 1 ? version.words[0] : "";
  if (std::find(known.begin(), known.end(), word) != known.end()) return {};
  return error_at_line(ErrorCode::unsupported, file, version.line,
                       "PCD version " + in_quotes(word) + " is unknown");
}

}  // namespace

Result<PcdHeader> parse_pcd_header(LineReader& lines, const std::string& file) {
  const auto entries = read_entries(lines, file);
  if (!entries) return entries.error();
  if (const auto version = check_version(*entries, file); !version) return version.error();
  auto fields = read_fields(*entries, file);
  if (!fields) return fields.error();
  const auto point_count = read_point_count(*entries, file);
  if (!point_count) return point_count.error();
  const auto encoding = read_encoding(*entries, file);
  if (!encoding) return encoding.error();
  return PcdHeader{*std::move(fields), (*entries)["FIELDS"].line, *point_count, *encoding};
}

}  // namespace pointreel::io
