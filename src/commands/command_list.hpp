// Each command adds itself to the command line.
#pragma once

#include <CLI/CLI.hpp>

namespace lichtveld::commands {

void add_bake(CLI::App& application);
void add_bench(CLI::App& application);
void add_check(CLI::App& application);
void add_info(CLI::App& application);
void add_serve(CLI::App& application);
void add_unwrap(CLI::App& application);

}  // namespace lichtveld::commands
