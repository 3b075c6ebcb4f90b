// The output of a verb that writes a .reel: a file, or - for standard output.
#pragma once

#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "pointreel/reel.h"

namespace pointreel {

class ReelOutput {
 public:
  // Writes the header at once.
  static Result<std::unique_ptr<ReelOutput>> open(const std::string& argument, const StreamHeader& header) {
    auto output = std::unique_ptr<ReelOutput>(new ReelOutput);
    if (argument != "-") {
      output->file_.open(argument, std::ios::binary);
      if (!output->file_) return Error{ErrorCode::io_error, argument + ": cannot open for writing"};
    }
    auto writer = ReelWriter::create(argument == "-" ? std::cout : output->file_, header);
    if (!writer) return writer.error();
    output->writer_.emplace(*std::move(writer));
    return output;
  }

  ReelWriter& writer() { return *writer_; }

 private:
  ReelOutput() = default;
  std::ofstream file_;
  std::optional<ReelWriter> writer_;
};

}  // namespace pointreel
