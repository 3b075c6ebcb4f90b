#include "motion/text_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

namespace pointreel {
namespace {

constexpr std::size_t kMaxLineLength = 4096;
constexpr std::size_t kMaxLines = std::size_t{1} << 26;  // 18 hours of a 1 kHz IMU
constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::string_view kUtf8ByteOrderMark = "\xEF\xBB\xBF";

std::vector<std::string_view> split_at_blanks(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t begin = text.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t begin = 0;
  std::size_t comma = text.find(',');
  while (comma != std::string_view::npos) {
    words.push_back(trim_blanks(text.substr(begin, comma - begin)));
    begin = comma + 1;
    comma = text.find(',', begin);
  }
  words.push_back(trim_blanks(text.substr(begin)));
  return words;
}

}  // namespace

Error TextLine::error(std::string_view what) const {
  return {ErrorCode::corrupt, path.string() + ":" + std::to_string(number) + ": " + std::string(what)};
}

Error file_error(ErrorCode code, const std::filesystem::path& path, std::string_view what) {
  return {code, path.string() + ": " + std::string(what)};
}

Result<void> for_each_line(const std::filesystem::path& path,
                           const std::function<Result<void>(const TextLine&)>& on_line) {
  std::ifstream file(path);
  if (!file) return file_error(ErrorCode::io_error, path, "cannot be opened");

  std::array<char, kMaxLineLength + 1> buffer{};
  TextLine line{path, 0, {}};
  while (file.getline(buffer.data(), buffer.size())) {
    ++line.number;
    if (line.number > kMaxLines) {
      return file_error(ErrorCode::resource_limit, path,
                        "has more than " + std::to_string(kMaxLines) + " lines");
    }
    const auto extracted = static_cast<std::size_t>(file.gcount());  // with the line end, where there is one
    line.text = {buffer.data(), file.eof() ? extracted : extracted - 1};
    if (line.number == 1 && line.text.starts_with(kUtf8ByteOrderMark)) {
      line.text.remove_prefix(kUtf8ByteOrderMark.size());
    }
    line.text = trim_blanks(line.text);
    if (line.text.empty() || line.text.front() == '#') continue;
    if (auto accepted = on_line(line); !accepted) return accepted;
  }
  if (file.bad()) return file_error(ErrorCode::io_error, path, "cannot be read");
  if (!file.eof()) {
    ++line.number;
    return line.error("the line is longer than " + std::to_string(kMaxLineLength) + " characters");
  }
  return {};
}

std::string_view trim_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> split(std::string_view text, Separator separator) {
  return separator == Separator::comma ? split_at_commas(text) : split_at_blanks(text);
}

std::optional<double> parse_number(std::string_view text) {
  // from_chars takes no plus sign, files do.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<std::vector<double>> parse_numbers(const TextLine& line, Separator separator) {
  std::vector<double> numbers;
  for (const std::string_view word : split(line.text, separator)) {
    const std::optional<double> number = parse_number(word);
    if (!number) return line.error(std::string(word) + " is not a finite number");
    numbers.push_back(*number);
  }
  return numbers;
}

Result<std::vector<double>> parse_numbers(const TextLine& line, Separator separator, std::size_t count) {
  auto numbers = parse_numbers(line, separator);
  if (numbers && numbers->size() != count) {
    return line.error("has " + std::to_string(numbers->size()) + " numbers where " + std::to_string(count) +
                      " are needed");
  }
  return numbers;
}

void append_number(std::string& text, double value) {
  std::array<char, 32> digits{};  // the longest shortest double has 24 characters
  const auto [end, status] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

Result<void> write_text_file(const std::filesystem::path& path, std::string_view text) {
  // By way of a temporary name, so that a full disk leaves no half file behind.
  std::filesystem::path temporary = path;
  temporary += ".partial";
  std::ofstream file(temporary, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code failure;
  if (file) std::filesystem::rename(temporary, path, failure);
  if (!file || failure) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return file_error(ErrorCode::io_error, path, "cannot be written");
  }
  return {};
}

}  // namespace pointreel
