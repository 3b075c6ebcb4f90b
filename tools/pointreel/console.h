// What goes to the terminal: errors, notes, a progress bar.
#pragma once

#include <cstddef>
#include <string_view>

#include "pointreel/result.h"

namespace pointreel {

void print_error(const Error& error);
void print_note(std::string_view text);

// A bar on stderr, drawn only when stderr is a terminal; gone when the object is.
class Progress {
 public:
  Progress(std::string_view verb, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance_to(std::size_t done);

 private:
  std::string_view verb_;
  std::size_t total_;
  bool visible_;
};

}  // namespace pointreel
