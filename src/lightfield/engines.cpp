#include <algorithm>
#include <array>
#include <stdexcept>

#include "lichtveld/lightfield/engine.hpp"
#include "links/links.hpp"
#include "rays/rays.hpp"
#include "thesis/thesis.hpp"

namespace lichtveld::lightfield {

namespace {

template <typename Field>
std::unique_ptr<LightField> make(const gpu::Device& device, const scene::Scene& scene,
                                 const Settings& settings) {
  check(settings);
  Settings own = settings;
  if (!scene.punctual.empty() || scene.sky) {
    if (settings.direct == Direct::psf)
      throw std::invalid_argument(
          "--direct psf: " +
          (scene.sky ? "the sky" : "the light of node \"" + scene.punctual.front().node + "\"") +
          " has no surface that directions could find; leave --direct out");
    own.direct = Direct::exact;
  }
  return std::make_unique<Field>(device, scene, own);
}

constexpr std::array all = {
    Engine{"thesis", "every PSF rendered afresh in every bounce", 384, make<Thesis>},
    Engine{"links", "what each texel sees is kept, a move redoes only what it touched", 384, make<Links>},
    Engine{"rays", "the same found by rays, wholly on the CPU, with exact light from lamps", 96, make<Rays>},
};

}  // namespace

std::span<const Engine> engines() {
  return all;
}

const Engine& engine(std::string_view name) {
  const auto found = std::ranges::find(all, name, [](const Engine& one) { return std::string_view(one.name); });
  if (found != all.end()) return *found;
  std::string names;
  for (const auto& one : all) names += (names.empty() ? "" : ", ") + std::string(one.name);
  throw std::invalid_argument("no engine is called " + std::string(name) + "; there are: " + names);
}

std::unique_ptr<LightField> make_light_field(std::string_view name, const gpu::Device& device,
                                             const scene::Scene& scene, const Settings& settings) {
  return engine(name).make(device, scene, settings);
}

}  // namespace lichtveld::lightfield
