// Lines and words of headers and of ASCII bodies, views into the file's bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace pointreel::io {

class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  // False at the end of the text. Lines may end in \n or \r\n, the last one also in nothing.
  bool next(std::string_view& line) {
    if (offset_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
    line = text_.substr(offset_, end - offset_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    offset_ = std::min(end + 1, text_.size());
    ++line_number_;
    return true;
  }

  // The next line that is not blank.
  bool next_words(std::vector<std::string_view>& words) {
    std::string_view line;
    words.clear();
    while (words.empty() && next(line)) split(line, words);
    return !words.empty();
  }

  std::size_t line_number() const { return line_number_; }  // of the line given last, from 1
  std::size_t offset() const { return offset_; }            // of the first byte after that line
  std::size_t bytes_left() const { return text_.size() - offset_; }

 private:
  static void split(std::string_view line, std::vector<std::string_view>& words) {
    constexpr std::string_view blanks = " \t\r\v\f";
    for (std::size_t begin = line.find_first_not_of(blanks); begin != line.npos;
         begin = line.find_first_not_of(blanks, begin)) {
      const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
      words.push_back(line.substr(begin, end - begin));
      begin = end;
    }
  }

  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_number_ = 0;
};

}  // namespace pointreel::io
