// What `lichtveld --version` prints.
#pragma once

#include <string>

namespace lichtveld::commands {

// Version, commit, the device that would be chosen, and the libraries that this was built with.
std::string version();

}  // namespace lichtveld::commands
