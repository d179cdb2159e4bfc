#include "lichtveld/files/output.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "write_file.hpp"

namespace lichtveld::files {

namespace fs = std::filesystem;

namespace {

// As many as Linux follows.
constexpr int max_links = 40;

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw OutputError(file.string() + " cannot be written: " + why);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// Not there, or not to be looked at, is an answer too; a name that no file can have is none.
fs::file_status status_of(const fs::path& file) {
  std::error_code error;
  const auto status = fs::status(file, error);
  if (error == std::errc::filename_too_long) fail(file, "the name is too long; give a shorter one");
  if (error == std::errc::too_many_symbolic_link_levels)
    fail(file, "its symbolic links lead in a circle; remove them or name another file");
  return status;
}

}  // namespace

void check_place(const fs::path& file) {
  if (fs::is_directory(status_of(file))) fail(file, "it is a folder; name a file in it");
  const auto folder = folder_of(target_of(file));
  if (!fs::is_directory(status_of(folder))) fail(file, folder.string() + " is not a folder; make it first");
}

void check_place(const fs::path& file, const std::string& extension) {
  check_place(file);
  if (file.extension() != extension) fail(file, "this is a " + extension + " file; name it so");
}

void check_distinct(const std::vector<NamedFile>& files) {
  for (auto later = files.begin(); later != files.end(); ++later)
    for (auto earlier = files.begin(); earlier != later; ++earlier)
      if (target_of(earlier->file) == target_of(later->file))
        throw OutputError(earlier->name + " " + earlier->file.string() + " and " + later->name + " " +
                          later->file.string() + " are the same file; give each its own");
}

fs::path target_of(const fs::path& file) {
  fs::path target = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, error)); ++links) {
    if (links == max_links) fail(file, "its symbolic links lead in a circle; remove them or name another file");
    // An absolute link replaces the folder.
    target = folder_of(target) / fs::read_symlink(target, error);
  }
  const auto canonical = fs::weakly_canonical(fs::absolute(target), error);
  return error ? target : canonical;
}

void make_folder(const fs::path& folder) {
  std::error_code error, unknown;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, unknown))
    throw OutputError(folder.string() + " cannot be made a folder" + (error ? ": " + error.message() : ""));
}

void write_bytes(const fs::path& file, std::span<const std::uint8_t> bytes) {
  check_place(file);
  try {
    // /proc/self/fd/1, say, is a link that names no file when it leads to a pipe: it is opened as it stands.
    if (const auto status = status_of(file); fs::exists(status) && !fs::is_regular_file(status))
      write_into(file, bytes);
    else
      write_and_rename(target_of(file), bytes);
  } catch (const std::system_error& error) {
    fail(file, error.code().message() + "; is there room, and may you write there?");
  }
}

void write_text(const fs::path& file, const std::string& text) {
  write_bytes(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_exr(const fs::path& file, std::span<const glm::vec4> pixels, std::uint32_t size) {
  std::vector<std::uint8_t> exr;
  OIIO::Filesystem::IOVecOutput memory(exr);
  const auto side = static_cast<int>(size);
  const OIIO::ImageSpec spec(side, side, 4, OIIO::TypeDesc::FLOAT);
  const auto out = OIIO::ImageOutput::create("map.exr", &memory);
  if (!out || !out->open("map.exr", spec) || !out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) ||
      !out->close())
    throw std::runtime_error("cannot encode " + file.string() +
                             " as EXR: " + (out ? out->geterror() : OIIO::geterror()));
  write_bytes(file, exr);
}

}  // namespace lichtveld::files
