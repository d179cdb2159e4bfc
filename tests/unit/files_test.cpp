// Fingerprints of files.
#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "lichtveld/files/hash.hpp"

namespace lichtveld::files {
namespace {

class Hash : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& content) {
    const auto file = folder_ / "scene.glb";
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("lichtveld-hash-" + std::to_string(getpid()));
};

TEST_F(Hash, KnownAnswers) {  // FIPS 180-4's examples
  EXPECT_EQ(sha256_of_file(write("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(write("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(write(std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(Hash, WhatCannotBeReadIsNamed) {
  for (const auto& path : {folder_ / "missing.glb", folder_}) {
    try {
      sha256_of_file(path);
      FAIL() << path;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(path.string()));
    }
  }
}

}  // namespace
}  // namespace lichtveld::files
