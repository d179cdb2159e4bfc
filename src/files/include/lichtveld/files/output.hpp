// Output files: complete or not there at all. Each is written beside its place and then renamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <string>

namespace lichtveld::files {

// An output file that cannot be written. The message names it and says what to try.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws OutputError if there is no folder for such a file, or a folder in its place: worth asking before long
// work.
void check_place(const std::filesystem::path& file);

// The same for a file whose format its extension names: ".exr".
void check_place(const std::filesystem::path& file, const std::string& extension);

// Makes a folder for output, and those above it. Throws OutputError if that cannot be.
void make_folder(const std::filesystem::path& folder);

// Calls write(temporary), then renames the temporary file to `file`; removes it if either fails. The temporary
// keeps the extension. Throws OutputError if the folder is not there or cannot be written to.
void write_whole(const std::filesystem::path& file,
                 const std::function<void(const std::filesystem::path&)>& write);

void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& file, const std::string& text);

// size * size 32-bit float RGBA scanlines, row 0 on top.
void write_exr(const std::filesystem::path& file, std::span<const glm::vec4> pixels, std::uint32_t size);

}  // namespace lichtveld::files
