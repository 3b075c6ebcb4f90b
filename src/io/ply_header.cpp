#include "io/ply_header.h"

#include <algorithm>

#include "io/file_error.h"
#include "io/text_lines.h"

namespace pointreel::io {
namespace {

using Words = std::vector<std::string_view>;

// Both families of names occur in files.
std::optional<ScalarType> scalar_type(std::string_view name) {
  constexpr std::array<std::string_view, 10> sized_names = {"int8",   "uint8", "int16", "uint16",  "int32",
                                                            "uint32", "",      "",      "float32", "float64"};
  if (name.empty()) return std::nullopt;
  for (const auto& names : {ply_type_names, sized_names}) {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return static_cast<ScalarType>(it - names.begin());
  }
  return std::nullopt;
}

// Reads one header line after the other into header().
class HeaderParser {
 public:
  HeaderParser(LineReader& lines, const std::string& file) : lines_(lines), file_(file) {}

  Result<PlyHeader> parse() {
    Words words;
    if (!lines_.next_words(words) || words != Words{"ply"})
      return error("is not 'ply', so this is no PLY file");
    while (lines_.next_words(words)) {
      if (words[0] == "end_header") return finish();
      const auto line = parse_line(words);
      if (!line) return line.error();
    }
    return error("the file ends before end_header", ErrorCode::truncated);
  }

 private:
  Error error(std::string_view what, ErrorCode code = ErrorCode::corrupt) const {
    return error_at_line(code, file_, lines_.line_number(), what);
  }

  Result<PlyHeader> finish() {
    if (!has_format_) return error("the header has no format line");
    return std::move(header_);
  }

  Result<void> parse_line(const Words& words) {
    if (words[0] == "comment" || words[0] == "obj_info") return {};
    if (words[0] == "format") return parse_format(words);
    if (words[0] == "element") return parse_element(words);
    if (words[0] == "property") return parse_property(words);
    return error(in_quotes(words[0]) + " is no keyword of a PLY header");
  }

  Result<void> parse_format(const Words& words) {
    if (words.size() != 3) return error("is no format line such as 'format ascii 1.0'");
    if (words[2] != "1.0")
      return error("PLY version " + in_quotes(words[2]) + " is unknown", ErrorCode::unsupported);
    has_format_ = true;
    if (words[1] == "ascii") {
      header_.byte_order = std::nullopt;
    } else if (words[1] == "binary_little_endian") {
      header_.byte_order = std::endian::little;
    } else if (words[1] == "binary_big_endian") {
      header_.byte_order = std::endian::big;
    } else {
      return error("PLY format " + in_quotes(words[1]) + " is unknown", ErrorCode::unsupported);
    }
    return {};
  }

  Result<void> parse_element(const Words& words) {
    const auto count = words.size() == 3 ? parse_number<std::uint64_t>(words[2]) : std::nullopt;
    if (!count) return error("is no element line such as 'element vertex 8'");
    const auto& elements = header_.elements;
    if (std::any_of(elements.begin(), elements.end(), [&](const auto& e) { return e.name == words[1]; })) {
      return error("element " + in_quotes(words[1]) + " is there twice");
    }
    header_.elements.push_back({std::string(words[1]), lines_.line_number(), *count, {}});
    return {};
  }

  Result<void> parse_property(const Words& words) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (words.size() != 3 && !is_list) return error("is no property line such as 'property float x'");
    if (header_.elements.empty()) return error("a property stands before any element");
    const std::string_view type_name = words[words.size() - 2];
    const auto type = scalar_type(type_name);
    if (!type) return error("type " + in_quotes(type_name) + " is unknown", ErrorCode::unsupported);
    PlyProperty property{std::string(words.back()), *type, std::nullopt};
    if (is_list) {
      property.list_length_type = scalar_type(words[2]);
      if (!property.list_length_type || is_float(*property.list_length_type)) {
        return error("list lengths cannot be of type " + in_quotes(words[2]));
      }
    }
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  LineReader& lines_;
  const std::string& file_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

Result<PlyHeader> parse_ply_header(LineReader& lines, const std::string& file) {
  return HeaderParser(lines, file).parse();
}

}  // namespace pointreel::io
