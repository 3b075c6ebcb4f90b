// The verbs of the command line: each adds its subcommand and returns the function that runs it.
#pragma once

#include <CLI/App.hpp>
#include <functional>

namespace pointreel {

using Verb = std::function<int()>;  // an ExitCode

Verb add_encode(CLI::App& app);
Verb add_decode(CLI::App& app);
Verb add_info(CLI::App& app);
Verb add_verify(CLI::App& app);
Verb add_planes(CLI::App& app);
Verb add_simulate(CLI::App& app);
Verb add_bench(CLI::App& app);

}  // namespace pointreel
