// Geometry and atlases as they should not be: coincident and coplanar faces, slivers, charts without gutters.
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

constexpr float le = 10;  // [W m^-2 sr^-1]

// Floor and ceiling of a cube with black walls, built in some odd way.
Case odd_squares(const std::string& name, const std::string& formula,
                 const std::function<void(SceneBuilder&, int lamp, int floor)>& build,
                 std::optional<double> known_stencil = {}, const std::string& known = "") {
  return {.name = name,
          .formula = formula + " E = pi Le F all the same, F = 0.199825 (Howell, C-11).",
          .scenes =
              [=] {
                SceneBuilder builder;
                build(builder, builder.material(glm::vec3(0), glm::vec3(le)), builder.material(glm::vec3(0)));
                black_room(builder, "ceiling");
                return std::vector{loaded(builder)};
              },
          .size = 64,
          .psf = 1536,
          .bounces = 1,
          .spp = 256,
          .figures = {{"mean E of the floor",
                       pi * parallel_squares * le,
                       [](const Texels& map) { return mean(of(map, "floor")); },
                       {{{0.02, known_stencil}, {0.02}, {0.002}, {0.001}}},
                       "as the parallel squares: nothing about the light has changed.",
                       known}}};
}

// A lid on the floor, face to face with it.
Case contact() {
  return {.name = "faces_in_contact",
          .formula = "A lid that lies on the floor hides it from the lamp: 0.",
          .scenes =
              [=] {
                SceneBuilder builder;
                square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(le)));
                square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5f)));
                square(builder, "lid", 0, true, chart_c, builder.material(glm::vec3(0.5f)));
                return std::vector{loaded(builder)};
              },
          .size = 64,
          .psf = 384,
          .bounces = 2,
          .spp = 64,
          .figures = {{"brightest covered texel, as a share",
                       0,
                       [](const Texels& map) {
                         constexpr double inner = 1 - 2 * 2 * 1.7320508 / 64;  // two PSF pixels off the rim
                         return most(where(map,
                                           [](const Texel& texel) {
                                             return texel.node == "floor" &&
                                                    std::abs(texel.position.x) < inner &&
                                                    std::abs(texel.position.z) < inner;
                                           })) /
                                (pi * le);
                       },
                       {{{0, 0.06}, {0}, {0}, {0}}},
                       "exactly 0: equal depths count as in front.",
                       "where the lamp's outline crosses a pixel, some of its samples count one layer less, so "
                       "that the lid is the second layer of some samples, the first of others, and kept in "
                       "none. The list does not lose it."}}};
}

// A lit floor, and far above it a dark ceiling over a floor of its own. Lamp and dark ceiling touch in the
// atlas.
Case touching_charts() {
  return {
      .name = "charts_without_gutter",
      .formula = "A lamp's chart touches that of a black ceiling elsewhere: the floor under that is dark, 0.",
      .scenes =
          [=] {
            SceneBuilder builder;
            const int black = builder.material(glm::vec3(0));
            square(builder, "lamp", 2, true, {0.125f, 0.125f, 0.375f, 0.375f},
                   builder.material(glm::vec3(0), glm::vec3(le)));
            square(builder, "floor", 0, false, chart_c, black);
            square(builder, "dark ceiling", 7, true, {0.375f, 0.125f, 0.625f, 0.375f}, black);
            square(builder, "dark floor", 5, false, chart_d, black);
            return std::vector{loaded(builder)};
          },
      .size = 64,
      .psf = 384,
      .bounces = 1,
      .spp = 64,
      .figures = {{"mean of the dark floor over the lit one",
                   0,
                   [](const Texels& map) { return mean(of(map, "dark floor")) / mean(of(map, "floor")); },
                   {{{0, 0.03}, {0, 0.02}, {0}, {0}}},
                   "exactly 0: nothing that glows faces the dark floor.",
                   "a surface's radiance is read from the map with bilinear filtering, which takes in half a "
                   "texel of the neighbouring chart. Unwrap with gutters of two texels."}}};
}

// A closed room that glows all over, with charts whose edges run through texels' centres.
Case edge_texels() {
  constexpr float half = 0.5f / 64, cell = 16.f / 64;  // 2 texels of it gutter on every side
  return {
      .name = "texels_on_edges",
      .formula = "Texels that lie on the line where two walls meet: E = pi Le, as everywhere in such a room.",
      .scenes =
          [=] {
            SceneBuilder builder;
            builder.box("room", glm::vec3(-1), glm::vec3(1), {half, half, half + 3 * cell, half + 2 * cell},
                        builder.material(glm::vec3(0), glm::vec3(1)), true);
            return std::vector{loaded(builder)};
          },
      .size = 64,
      .psf = 96,
      .bounces = 1,
      .spp = 64,
      .figures = {
          {"share of texels over 1 % off",
           0,
           [](const Texels& map) {
             return share_off(
                 map, [](const Texel&) { return pi; }, 0.01);
           },
           {{{0.01, 0.3}, {0.01}, {0.01}, {0.01}}},
           "a hundredth of the texels: those in the very corners are on no side of three walls at once.",
           "layers are lost along outlines, as in the other rooms, and here every edge of the room is one."}}};
}

}  // namespace

std::vector<Case> mesh_cases() {
  return {
      odd_squares("lamp_twice", "The same lamp twice at the same place counts once.",
                  [](SceneBuilder& builder, int lamp, int floor) {
                    square(builder, "lamp", 2, true, chart_a, lamp);
                    square(builder, "lamp again", 2, true, chart_c, lamp);
                    square(builder, "floor", 0, false, chart_b, floor);
                  }),
      odd_squares(
          "coplanar_halves", "Lamp and floor of two coplanar halves each, that share an edge and no chart.",
          [](SceneBuilder& builder, int lamp, int floor) {
            const auto half = [&](const char* name, float from, float y, bool down, Chart c, int material) {
              const float l = from, r = from + 1;
              if (down)
                builder.quad(name, {glm::vec3(l, y, -1), {r, y, -1}, {r, y, 1}, {l, y, 1}}, c, material);
              else
                builder.quad(name, {glm::vec3(l, y, 1), {r, y, 1}, {r, y, -1}, {l, y, -1}}, c, material);
            };
            half("lamp", -1, 2, true, chart_a, lamp);
            half("lamp", 0, 2, true, chart_c, lamp);
            half("floor", -1, 0, false, chart_b, floor);
            half("floor", 0, 0, false, chart_d, floor);
          }),
      odd_squares("slivers", "Lamp and floor as fans of 400 slivers, each followed by a triangle without area.",
                  [](SceneBuilder& builder, int lamp, int floor) {
                    sliver_square(builder, "lamp", 2, true, chart_a, lamp, 400);
                    sliver_square(builder, "floor", 0, false, chart_b, floor, 400);
                  }),
      contact(),
      touching_charts(),
      edge_texels()};
}

}  // namespace lichtveld::stability
