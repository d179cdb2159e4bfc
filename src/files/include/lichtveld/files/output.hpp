// Output files: complete or not there at all. Each is written beside its place and then renamed; SIGHUP,
// SIGINT, SIGQUIT and SIGTERM wait for that, so only SIGKILL or a power cut can leave the hidden file behind.
//
// A symbolic link stays one: its target is written. What is there and no regular file, a device or a pipe, is
// written into; a pipe that nobody reads is waited for, as by any other program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace lichtveld::files {

// An output file that cannot be written. The message names it and says what to try.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws OutputError if no such file can be: its folder is missing, it is a folder itself, its name is too
// long. Worth asking before long work.
void check_place(const std::filesystem::path& file);

// The same for a file whose format its extension names: ".exr".
void check_place(const std::filesystem::path& file, const std::string& extension);

// A file and what the user calls it: "--out".
struct NamedFile {
  std::string name;
  std::filesystem::path file;
};

// Throws OutputError if two of these are one file, whatever its spelling and through whichever links.
void check_distinct(const std::vector<NamedFile>& files);

// The file that is written for this name: links followed to their end, there or not, and one spelling for each
// file. Throws OutputError if links lead nowhere but to each other.
std::filesystem::path target_of(const std::filesystem::path& file);

// Makes a folder for output, and those above it. Throws OutputError if that cannot be.
void make_folder(const std::filesystem::path& folder);

// A file that was there keeps its permissions and, if we may, its owner. Throws OutputError if it cannot be
// written; what was there is then as before.
void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& file, const std::string& text);

// size * size 32-bit float RGBA scanlines, row 0 on top.
void write_exr(const std::filesystem::path& file, std::span<const glm::vec4> pixels, std::uint32_t size);

}  // namespace lichtveld::files
