// The two ways in which bytes get into a file. Both throw std::system_error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace lichtveld::files {

// Into what is there: a device or a pipe, opening which may wait for a reader.
void write_into(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

// Into a hidden file beside `file`, which then takes its place and its permissions. Signals that end the
// process are held meanwhile.
void write_and_rename(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace lichtveld::files
