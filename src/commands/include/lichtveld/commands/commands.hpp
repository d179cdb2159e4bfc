// The commands of the executable `lichtveld`.
#pragma once

namespace lichtveld::commands {

// Runs the command line and returns its exit status: 0 fine, 2 bad usage or input, 3 no usable device, 1
// anything else. Every error is one line on stderr that says what failed, on which input, and what to try.
int run(int argc, char** argv);

}  // namespace lichtveld::commands
