// lichtveld info: devices and their limits, and what a scene needs.
#include <fmt/format.h>

#include <cstdio>

#include "check.hpp"
#include "command_list.hpp"
#include "options.hpp"

namespace lichtveld::commands {

namespace {

void print_devices() {
  const auto devices = gpu::list_devices();
  if (devices.empty())
    throw gpu::NoDevice(
        "no Vulkan device: install a driver (mesa-vulkan-drivers has lavapipe, which needs no GPU)");
  for (std::size_t index = 0; index < devices.size(); ++index) {
    const auto& device = devices[index];
    std::printf("%zu: %s (%s)\n", index, device.name.c_str(), device.type.c_str());
    std::printf("   driver               %s\n", device.driver.c_str());
    std::printf("   memory               %llu MiB\n", static_cast<unsigned long long>(device.memory >> 20));
    std::printf("   largest image        %u texels a side\n", device.max_image_size);
    std::printf("   largest buffer       %llu MiB (bounds --abuffer list: size^2 * layers * 16 bytes)\n",
                static_cast<unsigned long long>(device.max_storage_buffer >> 20));
    std::printf("   samples a pixel      %u (8 stencil-routed layers take %u passes)\n", device.samples,
                (8 + device.samples - 1) / device.samples);
    std::printf("   subgroup             %u\n", device.subgroup_size);
    std::printf("   usable               %s\n",
                device.missing.empty() ? "yes" : ("no, lacks " + device.missing).c_str());
  }
}

void print_scene(const std::string& file, std::uint32_t size) {
  check(scene::UnwrapOptions{.size = size});
  const auto facts = scene::check(file, {.sky = {}, .lights = {}, .unwrap = {.size = size}}).facts;
  fmt::print("{}\n", scene::printable(file));
  const auto print = [](const char* what, const std::string& text) {
    fmt::print("   {:<20} {}\n", what, scene::printable(text));
  };
  print("triangles", fmt::format("{} in {} surfaces, {} materials, {} textures", facts.triangles,
                                 facts.surfaces, facts.materials, facts.textures));
  const auto& [centre, radius] = facts.sphere;
  print("bounding sphere",
        fmt::format("radius {:.3f} m around ({:.3f}, {:.3f}, {:.3f})", radius, centre.x, centre.y, centre.z));
  print("valid texels",
        fmt::format("{} of {} at --size {}", facts.atlas.texels, std::uint64_t{size} * size, size));
  for (const auto& [node, place, box] : facts.movable)
    print("movable", fmt::format("{} at ({:.3f}, {:.3f}, {:.3f}) m", node, place.x, place.y, place.z));
  for (const auto& light : facts.lights) print("light", line_of(light));
  print("more", "lichtveld check " + file);
}

}  // namespace

void add_info(CLI::App& application) {
  struct Options {
    std::string scene;
    std::uint32_t size = 256;
  };
  auto* command =
      application.add_subcommand("info", "List the devices and their limits, and what a scene needs");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "A scene, .glb or .gltf")->type_name("SCENE");
  command->add_option("--size", options->size, "Texels a side of the light map")->capture_default_str();
  command->callback([options] {
    print_devices();
    if (!options->scene.empty()) print_scene(options->scene, options->size);
  });
}

}  // namespace lichtveld::commands
