// The scene file's fingerprint, by which both sides know that they hold the same geometry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace lichtveld::files {

// Lower-case hex SHA-256 of a file's bytes. Throws std::runtime_error, which names the file, when it
// cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

// The same of bytes that are in no file yet.
std::string sha256_of(std::span<const std::uint8_t> bytes);

}  // namespace lichtveld::files
