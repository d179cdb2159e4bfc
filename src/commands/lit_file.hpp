// A scene's file as it is written for other programs, with its sky and its light map beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::commands {

// What lies beside a scene, and is to lie beside its copy.
struct FileBeside {
  std::filesystem::path from, to;
  std::vector<std::uint8_t> bytes;
};

// Reads the file of that name beside `scene`, to be written beside `out`; nothing where the name is empty or
// both are one place. Throws files::OutputError if it cannot be read, or not be written there.
std::vector<FileBeside> files_beside(const std::string& name, const std::filesystem::path& scene,
                                     const std::filesystem::path& out);

// Writes them, and says so. Throws files::OutputError.
void write(const std::vector<FileBeside>& files);

// A file's name as a URI: UTF-8, with what a URI gives a meaning to as %XX.
std::string uri_of(const std::filesystem::path& name);

// A scene that names its light map.
struct LitFile {
  std::vector<std::uint8_t> glb;
  std::vector<FileBeside> beside;
};

// Of a scene that was loaded from `file` with these options, whose light_map is not empty. Takes
// scene.unwrapped. Throws as scene::unwrap and files_beside.
LitFile lit_file(const std::filesystem::path& file, const scene::UnwrapOptions& options, scene::Scene& scene,
                 const std::filesystem::path& out);

}  // namespace lichtveld::commands
