#include "light_options.hpp"

#include <cmath>

#include "lichtveld/scene/lights.hpp"
#include "options.hpp"

namespace lichtveld::commands {

namespace {

constexpr float brightest = 1e6f;

struct Dimmed {
  std::string name;
  glm::vec3 scale;
};

Dimmed parse(const std::string& text) {
  const auto wrong = [&] {
    return UsageError("--light " + text +
                      ": write NAME=SCALE or NAME=R,G,B, from 0 on, as in --light lamp=0.5");
  };
  const auto equals = text.rfind('=');
  if (equals == std::string::npos) throw wrong();
  const auto parts = CLI::detail::split(text.substr(equals + 1), ',');
  if (parts.size() != 1 && parts.size() != 3) throw wrong();
  Dimmed dimmed{text.substr(0, equals), {}};
  for (int channel = 0; channel < 3; ++channel) {
    const auto& part = parts[parts.size() == 1 ? 0 : static_cast<std::size_t>(channel)];
    float& value = dimmed.scale[channel];
    if (!CLI::detail::lexical_cast(part, value) || !(value >= 0 && value <= brightest)) throw wrong();
  }
  return dimmed;
}

}  // namespace

void add_light_source_options(CLI::App& command, LightOptions& options) {
  command
      .add_option(
          "--sky", options.sky,
          "Light from outside: an equirectangular picture, whose suns become sharp, or one radiance from "
          "everywhere [W/m2/sr]")
      ->type_name("FILE.hdr|FILE.exr|R,G,B")
      ->default_str("what the scene says");
  command
      .add_option("--lumens-per-watt", options.lumens_per_watt,
                  "Divides the numbers of point, spot and directional lights, which are watts otherwise")
      ->capture_default_str();
}

void add_light_options(CLI::App& command, LightOptions& options) {
  add_light_source_options(command, options);
  command
      .add_option("--light", options.dimmed,
                  "Scale what a node's surfaces or its light give, or the sky (sky); repeats, the last counts")
      ->type_name("NAME=SCALE|R,G,B")
      ->allow_extra_args(false);
}

scene::LoadOptions load_options(const LightOptions& options, const scene::UnwrapOptions& unwrap) {
  if (!(options.lumens_per_watt > 0 && std::isfinite(options.lumens_per_watt)))
    throw UsageError("--lumens-per-watt: a number above 0, as 683");
  scene::LoadOptions load{
      .sky = options.sky, .lights = {}, .lumens_per_watt = options.lumens_per_watt, .unwrap = unwrap};
  for (const auto& text : options.dimmed) load.lights.push_back(parse(text).name);
  return load;
}

scene::Scene load(const std::string& file, const LightOptions& options, const scene::UnwrapOptions& unwrap) {
  return scene::load(file, load_options(options, unwrap));
}

scene::Scales scales_of(const scene::Scene& scene, const LightOptions& options) {
  auto scales = scene::full(scene);
  for (const auto& text : options.dimmed) {
    const auto [name, scale] = parse(text);
    for (const auto light : scene::find_lights(scene, name)) scales[light] = scale;
  }
  return scales;
}

}  // namespace lichtveld::commands
