// pointreel bench: every codec on the same sweeps. A program of its own does the work, which the libraries of
// all those codecs come with.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "pointreel/console.h"
#include "pointreel/exit_code.h"
#include "pointreel/verbs.h"

namespace pointreel {
namespace {

int run(const std::vector<std::string>& arguments) {
  std::error_code failed;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::string program = (self.parent_path() / "pointreel-bench").string();
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  print_error(
      {ErrorCode::unsupported, program + ": not found; it is built with the bench and not installed"});
  return kFailed;
}

}  // namespace

Verb add_bench(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("bench", "Measure every codec there is on the same sweeps");
  // All that follows is the program's, --help too.
  verb->prefix_command();
  verb->set_help_flag();
  return [verb] { return run(verb->remaining()); };
}

}  // namespace pointreel
