#include "lit_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "lichtveld/files/output.hpp"
#include "lichtveld/scene/unwrap.hpp"

namespace lichtveld::commands {

std::vector<FileBeside> files_beside(const std::string& name, const std::filesystem::path& scene,
                                     const std::filesystem::path& out) {
  if (name.empty()) return {};
  FileBeside file{scene.parent_path() / name, out.parent_path() / name, {}};
  if (files::target_of(file.from) == files::target_of(file.to)) return {};
  files::check_place(file.to);
  std::ifstream in(file.from, std::ios::binary);
  file.bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (!in || file.bytes.empty())
    throw files::OutputError(file.from.string() + ", the scene's sky, cannot be copied beside " + out.string() +
                             ": it cannot be read");
  return {std::move(file)};
}

void write(const std::vector<FileBeside>& files) {
  for (const auto& file : files) {
    files::write_bytes(file.to, file.bytes);
    spdlog::info("{}: the scene's sky, beside it", file.to.string());
  }
}

std::string uri_of(const std::filesystem::path& name) {
  constexpr std::string_view unreserved = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string uri;
  for (const char c : name.string())
    if (unreserved.find(c) != std::string_view::npos)
      uri += c;
    else
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

LitFile lit_file(const std::filesystem::path& file, const scene::UnwrapOptions& options, scene::Scene& scene,
                 const std::filesystem::path& out) {
  return {scene.unwrapped.empty() ? scene::unwrap(file, options).glb : std::move(scene.unwrapped),
          files_beside(scene.beside, file, out)};
}

}  // namespace lichtveld::commands
