// Lamps and openings that get small: known answers at every texel.
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "stability_case.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

constexpr unsigned size = 64, psfs = 384;
constexpr float le = 10;  // [W m^-2 sr^-1]

constexpr const char* few_directions =
    "a lamp is seen by the directions that hit it: one that is narrower than the gap between them lights some "
    "texels too much and others not at all, and one that is narrower than a PSF's pixel is missed by most of "
    "its rays. More `--psf`; more `--size`, for the pixels. Rays see a lamp by 64 points, of which a slit "
    "shows few or "
    "none.";
constexpr const char* cornell =
    "5 %, what the Cornell room has at these PSFs (docs/algorithm.md, Accuracy). The reference's noise is "
    "taken off.";

std::vector<Figure> of_the_floor(const Exact& exact, std::array<Limit, 4> mean_limits,
                                 std::array<Limit, 4> rmse_limits, const std::string& mean_reason,
                                 const std::string& known) {
  const auto failure = [&](const std::array<Limit, 4>& limits) {
    return std::ranges::any_of(limits, [](const Limit& limit) { return limit.known.has_value(); }) ? known : "";
  };
  return {{"mean of the floor over exact", 1,
           [=](const Texels& map) {
             const auto floor = of(map, "floor");
             return mean(floor) / mean(floor, exact);
           },
           mean_limits, mean_reason, failure(mean_limits)},
          {"rel_rmse of the floor", 0, [=](const Texels& map) { return rel_rmse(of(map, "floor"), exact); },
           rmse_limits, cornell, failure(rmse_limits)}};
}

// A lamp of side 2 * `half`, 5 cm under the middle of the ceiling of a black room 2 m wide.
Case shrinking_lamp(const std::string& name, float half, std::array<Limit, 4> mean_limits,
                    std::array<Limit, 4> rmse_limits) {
  const auto exact = [=](const Texel& texel) {
    return le * pi * rectangle_factor(texel.position.x, texel.position.z, half, half, 2);
  };
  return {.name = name,
          .formula = "E = pi Le F at each texel, F from a point to a parallel rectangle (Howell, B-3).",
          .scenes =
              [=] {
                SceneBuilder builder;
                square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(le)), half);
                square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0)));
                black_room(builder, "", 2.05f);
                return std::vector{loaded(builder)};
              },
          .size = size,
          .psf = psfs,
          .bounces = 1,
          .spp = 256,
          .figures = of_the_floor(exact, mean_limits, rmse_limits,
                                  "what E's mean over the floor misses is which directions lead from the lamp "
                                  "to the floor: about N = 38, whose outline leaves 2 N^-3/4 = 13 % to chance. "
                                  "Rays have the lamp in closed form, and owe rounding alone.",
                                  few_directions)};
}

// A black roof with a slit 4 m long and `pixels` PSF pixels wide, right under a sky that glows. The floor sees
// the slit, and the sky nowhere else.
Case slit(const std::string& name, double pixels, std::array<Limit, 4> mean_limits,
          std::array<Limit, 4> rmse_limits) {
  constexpr float x = 0.75f, z = 2.75f, height = 1, length = 2;
  constexpr glm::vec3 low(-1.05f, -0.05f, -2.8f),
      high(1.05f, 1.1f, 2.8f);  // a black shell, so that no ray is lost
  const float radius = glm::length(high - low) / 2;
  const auto half = static_cast<float>(pixels * radius / size);
  const auto exact = [=](const Texel& texel) {
    return le * pi * rectangle_factor(texel.position.x, texel.position.z, half, length, height);
  };
  return {
      .name = name,
      .formula = "What a slit shows of an even sky is a lamp of its shape: F as above (Howell, B-3).",
      .scenes =
          [=] {
            SceneBuilder builder;
            const int black = builder.material(glm::vec3(0));
            const auto down = [&](const char* name, float x0, float x1, float z0, float z1, float y,
                                  Chart chart, int material) {
              builder.quad(name, {glm::vec3(x0, y, z0), {x1, y, z0}, {x1, y, z1}, {x0, y, z1}}, chart,
                           material);
            };
            square(builder, "floor", 0, false, chart_b, black);
            down("sky", -0.5f, 0.5f, -2.5f, 2.5f, 1.05f, chart_a,
                 builder.material(glm::vec3(0), glm::vec3(le)));
            constexpr float cell = 1.f / 16;
            down("left", -x, -half, -z, z, height, {cell, 9 * cell, 3 * cell, 11 * cell}, black);
            down("right", half, x, -z, z, height, {5 * cell, 9 * cell, 7 * cell, 11 * cell}, black);
            down("near end", -half, half, length, z, height, {9 * cell, 9 * cell, 11 * cell, 11 * cell}, black);
            down("far end", -half, half, -z, -length, height, {13 * cell, 9 * cell, 15 * cell, 11 * cell},
                 black);
            return std::vector{loaded(builder)};
          },
      .size = size,
      .psf = psfs,
      .bounces = 1,
      .spp = 256,
      .figures = of_the_floor(
          exact, mean_limits, rmse_limits,
          "as the lamps, with N = 77 directions from the slit to the floor: 8 %. The reference finds the "
          "sky through the slit by chance, which leaves it 1 % of noise at a quarter pixel. Rays see the sky "
          "by sample points, one in a few hundred of which "
          "shows through that slit.",
          few_directions)};
}

}  // namespace

std::vector<Case> lamp_cases() {
  const double lamp = outline_error(psfs / 2 * 0.2), opening = outline_error(psfs / 2 * 0.4);
  return {
      shrinking_lamp("lamp_100_percent", 1, {{{lamp}, {lamp}, {0.002}, {1e-4}}},
                     {{{0.05, 0.12}, {0.05, 0.12}, {0.02}, {1e-3}}}),
      shrinking_lamp("lamp_30_percent", 0.3f, {{{lamp}, {lamp}, {0.002}, {1e-4}}},
                     {{{0.05, 0.7}, {0.05, 0.7}, {0.02}, {1e-3}}}),
      shrinking_lamp("lamp_10_percent", 0.1f, {{{lamp}, {lamp}, {0.002}, {1e-4}}},
                     {{{0.05, 2.4}, {0.05, 2.4}, {0.02}, {1e-3}}}),
      shrinking_lamp("lamp_3_percent", 0.03f, {{{lamp, 0.6}, {lamp, 0.6}, {0.002}, {1e-4}}},
                     {{{0.05, 9}, {0.05, 9}, {0.02}, {1e-3}}}),
      shrinking_lamp("lamp_1_percent", 0.01f, {{{lamp, 2}, {lamp, 2}, {0.002}, {1e-4}}},
                     {{{0.05, 40}, {0.05, 40}, {0.02}, {1e-3}}}),
      slit("slit_4_pixels", 4, {{{opening, 0.2}, {opening}, {0.01}, {0.01}}},
           {{{0.05, 0.3}, {0.05, 0.25}, {0.05}, {0.05}}}),
      slit("slit_1_pixel", 1, {{{opening, 0.7}, {opening}, {0.02}, {0.01}}},
           {{{0.05, 1.2}, {0.05, 0.8}, {0.05}, {0.05, 0.25}}}),
      slit("slit_quarter_pixel", 0.25, {{{opening, 2.5}, {opening}, {0.04}, {0.02, 0.05}}},
           {{{0.05, 4}, {0.05, 2.5}, {0.05}, {0.05, 1}}}),
  };
}

}  // namespace lichtveld::stability
