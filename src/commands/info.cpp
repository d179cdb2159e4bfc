// lichtveld info: devices and their limits, and what a scene needs.
#include <cstdio>

#include "command_list.hpp"
#include "lichtveld/scene/atlas.hpp"
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
  const auto scene = scene::load(file);
  const auto texels = scene::check_atlas(scene, size);
  const auto sphere = scene::bounding_sphere(scene);
  std::printf("%s\n", file.c_str());
  std::printf("   triangles            %zu in %zu surfaces, %zu materials, %zu textures\n",
              scene.indices.size() / 3, scene.surfaces.size(), scene.materials.size(), scene.textures.size());
  std::printf("   bounding sphere      radius %.3f m around (%.3f, %.3f, %.3f)\n", sphere.radius,
              sphere.centre.x, sphere.centre.y, sphere.centre.z);
  std::printf("   valid texels         %u of %u at --size %u\n", texels, size * size, size);
  for (std::size_t body = 1; body < scene.bodies.size(); ++body) {
    const auto& place = scene.bodies[body].place;
    std::printf("   movable              %s at (%.3f, %.3f, %.3f) m\n", scene.bodies[body].node.c_str(),
                place.x, place.y, place.z);
  }
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
