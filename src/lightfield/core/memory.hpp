// How much memory there is, so that what does not fit is told before it is taken.
#pragma once

#include <cstdint>
#include <string>

namespace lichtveld::lightfield {

// Bytes that the machine, the process' control group and its limit of address space leave.
std::uint64_t free_memory();

// Throws std::runtime_error if `what`, so many bytes, is more than `limit`, or with a limit of 0 more than
// three quarters of what is free. It says both, and ends with `instead`: what to try.
void require_memory(const std::string& what, std::uint64_t bytes, std::uint64_t limit,
                    const std::string& instead);

}  // namespace lichtveld::lightfield
