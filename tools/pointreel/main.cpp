// pointreel: compresses LiDAR drives. One file per verb; this one only picks.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <utility>
#include <vector>

#include "pointreel/exit_code.h"
#include "pointreel/verbs.h"

int main(int argc, char** argv) {
  using namespace pointreel;
  // Sweeps and range images are megabytes, made and dropped for each frame: kept in the heap instead of being
  // mapped and unmapped by the kernel every time, they cost a fifth less decoding time.
  mallopt(M_MMAP_THRESHOLD, 1 << 29);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  CLI::App app{"Compress sequences of LiDAR sweeps into .reel files, and back."};
  app.set_version_flag("--version", "pointreel " POINTREEL_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 finished with data loss (a truncated file, say).\n"
      "Lengths take units (2cm, 20mm, 0.02), angles too (0.18deg, 0.003rad). 'pointreel VERB --help' tells "
      "more.");

  // The order here is the order in the help text.
  const std::vector<std::pair<CLI::App*, Verb>> verbs = [&] {
    std::vector<std::pair<CLI::App*, Verb>> added;
    for (const auto add :
         {add_encode, add_decode, add_info, add_verify, add_planes, add_simulate, add_bench}) {
      Verb run = add(app);
      added.emplace_back(app.get_subcommands({}).back(), std::move(run));
    }
    return added;
  }();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongArguments;
  }
  for (const auto& [subcommand, run] : verbs) {
    if (subcommand->parsed()) return run();
  }
  return kWrongArguments;
}
