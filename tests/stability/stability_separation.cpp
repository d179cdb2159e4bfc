// Light where there must be none, and layers that must not be lost.
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "stability_case.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

// Two rooms of side 2 beside each other, each a closed box; one glows. The wall between them is two faces that
// turn their backs to each other, `pixels` PSF pixels apart.
Case dark_room(const std::string& name, double pixels) {
  constexpr unsigned size = 64;
  const double pixel = 2 * std::sqrt(6) / size;  // two rooms, 4 x 2 x 2: the sphere's diameter over the raster
  const auto half = static_cast<float>(pixels * pixel / 2);
  const std::string reason = "exactly 0: a sum of zeros has no rounding.";
  return {.name = name,
          .formula =
              "A closed room without a lamp beside a bright one: nothing gets through a wall, however thin. "
              "The shares are of the bright room's mean.",
          .scenes =
              [=] {
                SceneBuilder builder;
                builder.box("bright", {-2 - half, -1, -1}, {-half, 1, 1}, {0, 0, 1, 0.5f},
                            builder.material(glm::vec3(0.5f), glm::vec3(1)), true);
                builder.box("dark", {half, -1, -1}, {2 + half, 1, 1}, {0, 0.5f, 1, 1},
                            builder.material(glm::vec3(0.8f)), true);
                return std::vector{loaded(builder)};
              },
          .size = size,
          .psf = 96,
          .bounces = 3,
          .spp = 64,
          .figures = {{"mean of the dark room, as a share",
                       0,
                       [](const Texels& map) { return mean(of(map, "dark")) / mean(of(map, "bright")); },
                       {{{0, 0.03}, {0}, {0}, {0}}},
                       reason,
                       silhouettes},
                      {"brightest dark texel, as a share",
                       0,
                       [](const Texels& map) { return most(of(map, "dark")) / mean(of(map, "bright")); },
                       {{{0, 0.4}, {0}, {0}, {0}}},
                       reason,
                       silhouettes}}};
}

// K plates above each other, each of which glows downwards with its own radiance and is black on top, over a
// floor. They are so wide that the middle of each sees only the next one.
Case plates() {
  constexpr float wide = 3, apart = 0.25f, thick = 0.01f, gap = apart - thick;
  const auto glow = [](int plate) { return 1 + static_cast<float>(plate % 5); };
  const auto stack = [=](int count) {
    SceneBuilder builder;
    const int black = builder.material(glm::vec3(0));
    int charts = 0;
    const auto next = [&] {  // 4 x 4 texels in a cell of 8 x 8
      const auto u = static_cast<float>(charts % 8) / 8, v = static_cast<float>(charts / 8) / 8;
      ++charts;
      return Chart{u + 1.f / 32, v + 1.f / 32, u + 3.f / 32, v + 3.f / 32};
    };
    for (int plate = 0; plate < count; ++plate) {
      const float y = apart * static_cast<float>(plate);
      square(builder, "top", y, false, next(), black, wide);
      square(builder, "plate", y + gap, true, next(), builder.material(glm::vec3(0), glm::vec3(glow(plate))),
             wide);
    }
    return loaded(builder);
  };
  return {
      .name = "plates_1_to_32",
      .formula =
          "E on the top of each plate is pi Le F of the one above it, F from a point to a parallel rectangle "
          "(Howell, B-3): a layer that is lost shows as another plate's radiance. The worst of 32 stacks.",
      .scenes =
          [=] {
            std::vector<scene::Scene> stacks;
            for (int count = 1; count <= 32; ++count) stacks.push_back(stack(count));
            return stacks;
          },
      .size = 64,
      .psf = 96,
      .bounces = 1,
      .spp = 16,
      .figures = {{"worst texel in the middle of a plate",
                   0,
                   [=](const Texels& map) {
                     const auto middles = where(map, [](const Texel& texel) {
                       return texel.node == "top" && std::abs(texel.position.x) < 1 &&
                              std::abs(texel.position.z) < 1;
                     });
                     double worst = 0;
                     for (const auto& texel : middles) {
                       const double exact =
                           pi * glow(static_cast<int>(std::lround(texel.position.y / apart))) *
                           rectangle_factor(texel.position.x, texel.position.z, wide, wide, gap);
                       worst = std::max(worst, beyond_noise(texel, exact) / exact);
                     }
                     return worst;
                   },
                   {{{0.01, 0.8}, {0.01}, {0.01}, {1e-4}}},
                   "1 %: a layer that is lost shows as another plate's radiance, 20 % off at least. The "
                   "plates' rims are 8 gaps away: a direction that looks past them has a cosine under 0.12, "
                   "and with 96 PSFs 0.5 % of the weight at most. The reference's noise is taken off.",
                   "stencil routing counts layers sample by sample. Where the rim of a plate higher up crosses "
                   "a pixel, some of its samples count one layer less, and a layer between is in none of them "
                   "or in two. That takes a stack as high as the seventh plate, since lower rims are out of "
                   "sight of the middle; it is no limit of layers. The list holds all 32."}}};
}

// A floor with a box that goes through it, under a lamp. The texels in the box are asked.
Case inside(const std::string& name, bool double_sided, unsigned bounces, double expected,
            std::array<Limit, 4> limits, const std::string& formula, const std::string& reason,
            const std::string& known) {
  constexpr float half = 0.5f, margin = 0.12f;  // two PSF pixels
  return {.name = name,
          .formula = formula,
          .scenes =
              [=] {
                SceneBuilder builder;
                square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
                square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5f)));
                black_room(builder, "ceiling");
                builder.box("box", {-half, -0.4f, -half}, {half, 0.4f, half}, chart_c,
                            builder.material(glm::vec3(0.5f), glm::vec3(0), double_sided));
                return std::vector{loaded(builder)};
              },
          .size = 64,
          .psf = 1536,
          .bounces = bounces,
          .spp = 64,
          .figures = {{"mean E in the box over that without it", expected,
                       [=](const Texels& map) {
                         const auto within = where(map, [](const Texel& texel) {
                           return texel.node == "floor" && std::abs(texel.position.x) < half - margin &&
                                  std::abs(texel.position.z) < half - margin;
                         });
                         return mean(within) / mean(within, [](const Texel& texel) {
                                  return pi * 10 *
                                         rectangle_factor(texel.position.x, texel.position.z, 1, 1, 2);
                                });
                       },
                       limits, reason, known}}};
}

}  // namespace

std::vector<Case> separation_cases() {
  return {
      dark_room("dark_room_4_pixels", 4),
      dark_room("dark_room_2_pixels", 2),
      dark_room("dark_room_1_pixel", 1),
      dark_room("dark_room_half_pixel", 0.5),
      dark_room("dark_room_tenth_pixel", 0.1),
      plates(),
      inside("inside_one_sided", false, 1, 1, {{{0.03}, {0.03}, {0.005}, {0.001}}},
             "One-sided surfaces are not there from behind: the floor in a box is lit as without the box, by "
             "the ceiling of a black cube (Howell, B-3).",
             "3 %: of N = 184 directions that hit the lamp its outline leaves 2 N^-3/4 = 4 % to chance in one "
             "texel; the mean over 81 texels has less, though not as little as a whole floor, since these lie "
             "close together.",
             ""),
      inside("inside_double_sided", true, 1, 0, {{{0, 0.05}, {0}, {0}, {0}}},
             "A double-sided box is shut: no direct light in it.", "exactly 0: every direction meets the box.",
             "where the edge of a face crosses a pixel, stencil routing loses a layer of the box. The list "
             "does not."),
      inside("inside_double_sided_2_bounces", true, 2, 0, {{{0, 0.6}, {0, 0.6}, {0}, {0, 2e-4}}},
             "Shut for reflected light too: the box is lit from outside alone.",
             "exactly 0, as with one bounce.",
             "a double-sided surface has one texel for both faces, which sends what falls on its front both "
             "ways. Model walls with a thickness, as two one-sided faces. Rays tell both faces apart; a floor "
             "texel that "
             "the box's wall cuts through has one value for what of it is within and without.")};
}

}  // namespace lichtveld::stability
