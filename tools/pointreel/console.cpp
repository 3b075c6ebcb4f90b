#include "pointreel/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace pointreel {

void print_error(const Error& error) {
  fmt::print(stderr, "pointreel: {}\n", error.message);
}

void print_note(std::string_view text) {
  fmt::print(stderr, "pointreel: note: {}\n", text);
}

Progress::Progress(std::string_view verb, std::size_t total)
    : verb_(verb), total_(total), visible_(total > 1 && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void Progress::advance_to(std::size_t done) {
  if (!visible_) return;
  constexpr std::size_t kWidth = 40;
  const std::size_t filled = done >= total_ ? kWidth : kWidth * done / total_;
  fmt::print(stderr, "\r{} [{}{}] {}/{}", verb_, std::string(filled, '#'), std::string(kWidth - filled, '.'),
             done, total_);
  std::fflush(stderr);
}

}  // namespace pointreel
