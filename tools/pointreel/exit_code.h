// The tool's exit codes, as the help text gives them.
#pragma once

namespace pointreel {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,
  kWrongArguments = 2,
  kDataLoss = 3,  // finished, but something in the input could not be read
};

}  // namespace pointreel
