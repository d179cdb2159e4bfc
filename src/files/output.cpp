#include "lichtveld/files/output.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

namespace lichtveld::files {

namespace fs = std::filesystem;

void check_place(const fs::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw OutputError(file.string() + " cannot be written: " + folder.string() +
                      " is not a folder; make it first");
  if (fs::is_directory(file))
    throw OutputError(file.string() + " cannot be written: it is a folder; name a file in it");
}

void check_place(const fs::path& file, const std::string& extension) {
  check_place(file);
  if (file.extension() != extension)
    throw OutputError(file.string() + " cannot be written: this is a " + extension + " file; name it so");
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw OutputError(folder.string() + " cannot be made a folder" + (error ? ": " + error.message() : ""));
}

void write_whole(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  check_place(file);
  const fs::path temporary =
      file.parent_path() / fmt::format(".{}.{}{}", file.stem().string(), getpid(), file.extension().string());
  try {
    write(temporary);
    fs::rename(temporary, file);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw OutputError(file.string() + " cannot be written: " + error.what() +
                      "; is there room, and may you write there?");
  }
}

void write_bytes(const fs::path& file, std::span<const std::uint8_t> bytes) {
  write_whole(file, [&](const fs::path& temporary) {
    std::ofstream out;
    out.exceptions(std::ios::failbit | std::ios::badbit);
    out.open(temporary, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
  });
}

void write_text(const fs::path& file, const std::string& text) {
  write_bytes(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_exr(const fs::path& file, std::span<const glm::vec4> pixels, std::uint32_t size) {
  write_whole(file, [&](const fs::path& temporary) {
    const auto side = static_cast<int>(size);
    OIIO::ImageSpec spec(side, side, 4, OIIO::TypeDesc::FLOAT);
    const auto out = OIIO::ImageOutput::create(file.extension() == ".exr" ? file.string() : "x.exr");
    if (!out || !out->open(temporary.string(), spec) ||
        !out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !out->close())
      throw std::runtime_error(out ? out->geterror() : OIIO::geterror());
  });
}

}  // namespace lichtveld::files
