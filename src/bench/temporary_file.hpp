// A file that goes when its owner does.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace lichtveld::bench {

class TemporaryFile {
 public:
  // In a folder of its own: references are kept by their scene's name.
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / fmt::format("lichtveld-{}", getpid()) / name) {
    std::filesystem::create_directories(path_.parent_path());
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove_all(path_.parent_path(), ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  const std::filesystem::path path_;
};

}  // namespace lichtveld::bench
