// The .reel argument of a verb: a file, or - for standard input.
#pragma once

#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "pointreel/reel.h"

namespace pointreel {

class ReelInput {
 public:
  static Result<std::unique_ptr<ReelInput>> open(const std::string& argument) {
    auto input = std::unique_ptr<ReelInput>(new ReelInput);
    if (argument != "-") {
      input->file_.open(argument, std::ios::binary);
      if (!input->file_) return Error{ErrorCode::io_error, argument + ": cannot open for reading"};
    }
    std::istream& stream = argument == "-" ? std::cin : input->file_;
    auto reader = ReelReader::open(stream, argument == "-" ? "standard input" : argument);
    if (!reader) return reader.error();
    input->reader_.emplace(*std::move(reader));
    return input;
  }

  ReelReader& reader() { return *reader_; }

 private:
  ReelInput() = default;
  std::ifstream file_;
  std::optional<ReelReader> reader_;
};

}  // namespace pointreel
