// A file is one line of text, the key, which names everything that the map depends on; then the texels (4
// floats each), their standard errors (a float each), three counts, and a checksum of all that.
#include "reference_cache.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>

#include "lichtveld/bench/options.hpp"
#include "lichtveld/files/hash.hpp"
#include "lichtveld/files/output.hpp"

namespace lichtveld::bench {

namespace {

namespace fs = std::filesystem;

// Rises with every change of what path tracing computes, so that maps of before are not taken for the truth.
constexpr int tracer_version = 1;

struct Counts {
  std::uint64_t texels_valid, rays, misses;
};

// FNV-1a (Fowler, Noll, Vo 1991): tells damage, not malice.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3u;
  return hash;
}

std::string key_of(const scene::Scene& scene, const std::vector<glm::vec3>& offsets,
                   const reference::Settings& settings) {
  std::string key =
      fmt::format("lichtveld reference {} scene {} size {} bounces {} spp {} seed {} at", tracer_version,
                  files::sha256_of_file(scene.file), settings.size,
                  settings.bounces ? std::to_string(*settings.bounces) : "auto", settings.spp, settings.seed);
  for (const auto& offset : offsets) key += fmt::format(" {},{},{}", offset.x, offset.y, offset.z);
  return key + "\n";
}

template <typename Value>
void append(std::string& bytes, std::span<const Value> values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

template <typename Value>
void take(std::string_view& bytes, std::span<Value> values) {
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes.remove_prefix(values.size_bytes());
}

std::string packed(const std::string& key, const reference::Irradiance& light) {
  std::string bytes = key;
  append<glm::vec4>(bytes, light.texels);
  append<float>(bytes, light.standard_error);
  const Counts counts{light.texels_valid, light.rays, light.misses};
  append<Counts>(bytes, {&counts, 1});
  const auto sum = checksum(bytes);
  append<std::uint64_t>(bytes, {&sum, 1});
  return bytes;
}

// Nothing if these are not the bytes of that key, whole.
std::optional<reference::Irradiance> unpacked(std::string_view bytes, const std::string& key,
                                              std::uint32_t size) {
  const std::size_t texels = std::size_t{size} * size;
  if (bytes.size() != key.size() + texels * (sizeof(glm::vec4) + sizeof(float)) + sizeof(Counts) + 8 ||
      !bytes.starts_with(key))
    return {};
  std::uint64_t sum = 0;
  auto tail = bytes.substr(bytes.size() - sizeof sum);
  take<std::uint64_t>(tail, {&sum, 1});
  if (sum != checksum(bytes.substr(0, bytes.size() - sizeof sum))) return {};

  reference::Irradiance light;
  light.texels.resize(texels);
  light.standard_error.resize(texels);
  Counts counts{};
  bytes.remove_prefix(key.size());
  take<glm::vec4>(bytes, light.texels);
  take<float>(bytes, light.standard_error);
  take<Counts>(bytes, {&counts, 1});
  light.texels_valid = static_cast<std::uint32_t>(counts.texels_valid);
  light.rays = counts.rays;
  light.misses = counts.misses;
  return light;
}

std::optional<std::string> contents_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// A full disk costs the next run some minutes, not this one its result.
void keep(const fs::path& file, const std::string& bytes) {
  try {
    files::write_text(file, bytes);
  } catch (const files::OutputError& error) {
    spdlog::warn("the reference is not kept: {}", error.what());
  }
}

}  // namespace

fs::path default_reference_cache() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const fs::path base = cache != nullptr && *cache != 0 ? fs::path(cache)
                        : home != nullptr && *home != 0 ? fs::path(home) / ".cache"
                                                        : fs::temp_directory_path();
  return base / "lichtveld" / "reference";
}

ReferenceCache::ReferenceCache(fs::path folder) : folder_(std::move(folder)) {
  files::make_folder(folder_);
}

reference::Irradiance ReferenceCache::traced(const scene::Scene& scene, const std::vector<glm::vec3>& offsets,
                                             const reference::Settings& settings) const {
  const auto key = key_of(scene, offsets, settings);
  const fs::path scene_file = scene.file;
  const auto file = folder_ / fmt::format("{}-{}-{}spp-{:016x}.reference", scene_file.stem().string(),
                                          settings.size, settings.spp, checksum(key));
  const bool cached = scene_file.extension() == ".glb";
  if (const auto bytes = cached ? contents_of(file) : std::nullopt) {
    if (auto light = unpacked(*bytes, key, settings.size)) {
      spdlog::info("the reference of {} at {} texels is known: {}", scene_file.string(), settings.size,
                   file.string());
      return std::move(*light);
    }
    spdlog::warn("{} is damaged or not what its name says: the reference is traced anew", file.string());
  }
  spdlog::info("tracing the reference of {}: {} texels a side, {} paths a texel", scene_file.string(),
               settings.size, settings.spp);
  auto light = reference::trace(scene, offsets, settings);
  if (cached) keep(file, packed(key, light));
  return light;
}

}  // namespace lichtveld::bench
