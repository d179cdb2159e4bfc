#include "version.hpp"

#include <fmt/format.h>
#include <spdlog/version.h>

#include <vulkan/vulkan_core.h>
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "git_hash.h"
#include "lichtveld/gpu/device.hpp"

namespace lichtveld::commands {

namespace {

// As the commands choose it, --device aside.
std::string device_line() {
  const char* wanted = std::getenv("LICHTVELD_DEVICE");
  try {
    const auto device = gpu::chosen_device(wanted != nullptr ? wanted : "");
    return device.name + " (" + device.driver + ")";
  } catch (const gpu::NoDevice&) {
    return "no Vulkan device; lichtveld info says more";
  }
}

}  // namespace

std::string version() {
  std::string text = fmt::format("lichtveld {} ({})\n", LICHTVELD_VERSION, LICHTVELD_GIT_HASH);
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("   {:<20} {}\n", name, value);
  };
  add("device", device_line());
  add("Vulkan headers", fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(VK_HEADER_VERSION_COMPLETE),
                                    VK_API_VERSION_MINOR(VK_HEADER_VERSION_COMPLETE), VK_HEADER_VERSION));
  add("Embree", EMBREE_VERSION);
  add("OpenImageIO", OPENIMAGEIO_VERSION);
  add("libdatachannel", LIBDATACHANNEL_VERSION);
  add("nlohmann json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                   NLOHMANN_JSON_VERSION_PATCH));
  add("spdlog", fmt::format("{}.{}.{}", SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH));
  add("fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100));
  add("CLI11", CLI11_VERSION);
  text.pop_back();  // the command line ends it
  return text;
}

}  // namespace lichtveld::commands
