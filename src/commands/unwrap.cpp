// lichtveld unwrap: a scene with an atlas for its light map, as other programs read it.
#include <spdlog/spdlog.h>

#include "command_list.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/unwrap.hpp"
#include "lit_file.hpp"
#include "options.hpp"

namespace lichtveld::commands {

namespace {

struct UnwrapCommand {
  std::string scene, out;
  scene::UnwrapOptions options;
};

void unwrap(const UnwrapCommand& command) {
  check(command.options);
  files::check_place(command.out, ".glb");
  files::check_distinct({{"the scene", command.scene}, {"--out", command.out}});
  const progress::Work work("unwrap");
  const auto unwrapped = scene::unwrap(command.scene, command.options);
  // A sky stays a file of its own, which has to lie beside its scene.
  write(files_beside(unwrapped.beside, command.scene, command.out));
  files::write_bytes(command.out, unwrapped.glb);
  spdlog::info(
      "{}: {}", command.out,
      unwrapped.reason.empty() ? "with its own TEXCOORD_1, which needs no change" : summary_of(unwrapped));
  if (unwrapped.size > command.options.size)
    spdlog::warn("{}: its charts find no room in {} x {} texels; bake it with --size {}", command.out,
                 command.options.size, command.options.size, unwrapped.size);
}

}  // namespace

void add_unwrap(CLI::App& application) {
  auto* command = application.add_subcommand(
      "unwrap", "Give a scene TEXCOORD_1 for its light map; the other commands do so by themselves");
  const auto options = std::make_shared<UnwrapCommand>();
  command->add_option("scene", options->scene, "The scene, .glb or .gltf")->required()->type_name("SCENE");
  command->add_option("--out", options->out, "The same as one file without compression, with TEXCOORD_1")
      ->required()
      ->type_name("OUT.glb");
  command
      ->add_option("--size", options->options.size,
                   "Texels a side, 16..4096, that charts lie on whole, two apart; doubled until they find room")
      ->capture_default_str();
  command
      ->add_option("--texels-per-metre", options->options.texels_per_metre,
                   "Of every surface, times its node's extras.texels")
      ->default_str("as many as find room");
  command->callback([options] { unwrap(*options); });
}

}  // namespace lichtveld::commands
