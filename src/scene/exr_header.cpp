// The layout: OpenEXR, "File Layout": magic number and version, then headers of attributes, each a name, a
// type, a length and so many bytes; an empty name ends a header, and an empty header those of a file of several
// parts.
#include "exr_header.hpp"

#include <array>
#include <cstdint>
#include <fstream>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::uint32_t of_several_parts = 0x1000;  // of the version
constexpr std::size_t longest_name = 255;           // that the format allows

class Header {
 public:
  Header(const std::filesystem::path& file, const std::string& what)
      : in_(file, std::ios::binary), left_(std::filesystem::file_size(file)), what_(what) {}

  void check() {
    word();
    const bool many = (word() & of_several_parts) != 0;
    while (attributes() > 0 && many) {
    }
  }

 private:
  // Goes to the end of one header; how many it has.
  std::size_t attributes() {
    std::size_t count = 0;
    for (; !name().empty(); ++count) {
      name();  // of its type
      skip(word());
    }
    return count;
  }

  std::string name() {
    std::string text;
    for (char letter = 0; in_.get(letter) && letter != 0; text += letter)
      if (text.size() == longest_name) refuse();
    take(text.size() + 1);
    return text;
  }

  std::uint32_t word() {
    std::array<char, 4> bytes{};
    in_.read(bytes.data(), bytes.size());
    take(bytes.size());
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      value |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
    return value;
  }

  void skip(std::uint32_t bytes) {
    take(bytes);
    in_.seekg(bytes, std::ios::cur);
  }

  void take(std::uint64_t bytes) {
    if (!in_ || bytes > left_) refuse();
    left_ -= bytes;
  }

  [[noreturn]] void refuse() const {
    throw SceneError(what_ + " does not decode: its header says more than the file holds");
  }

  std::ifstream in_;
  std::uint64_t left_;
  const std::string& what_;
};

}  // namespace

void check_exr_header(const std::filesystem::path& file, const std::string& what) {
  Header(file, what).check();
}

}  // namespace lichtveld::scene
