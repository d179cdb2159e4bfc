// Lamps with a known form factor: E = pi F Le.
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

constexpr unsigned psfs = 1536;
constexpr float le = 10;  // of the lamps [W m^-2 sr^-1]

constexpr const char* many_texels =
    "2 %: of N = 153 directions that hit the lamp its outline leaves 2 N^-3/4 = 4.6 % to chance in one texel, "
    "and the mean over 24 x 24 texels less than half of that; the midpoint rule over them is 0.2 % off.";

// A lamp that the floor (y = 0, side 2 * floor_half) sees. The rest of the scene is `surroundings`.
Case factor(const std::string& name, const std::string& formula, double exact,
            const std::function<void(SceneBuilder&, int lamp)>& add_lamp,
            const std::function<void(SceneBuilder&)>& surroundings, std::array<Limit, 4> limits,
            const std::string& reason, float floor_half = 1, const std::string& known = "") {
  return {.name = name,
          .formula = formula,
          .scenes =
              [=] {
                SceneBuilder builder;
                add_lamp(builder, builder.material(glm::vec3(0), glm::vec3(le)));
                square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0)), floor_half);
                surroundings(builder);
                return std::vector{loaded(builder)};
              },
          .size = 64,
          .psf = psfs,
          .bounces = 1,
          .spp = 256,
          .figures = {{"mean E of the floor", pi * exact * le,
                       [](const Texels& map) { return mean(of(map, "floor")); }, limits, reason, known}}};
}

void at_the_ceiling(SceneBuilder& builder, int lamp) {
  square(builder, "lamp", 2, true, chart_a, lamp);
}

// Opposite squares of side 2 at distance c: Howell, B-3, over the texels of the floor.
double opposite_squares(double c) {
  double sum = 0;
  for (int k = 0; k < 576; ++k)
    sum += rectangle_factor((k % 24 + 0.5) / 12 - 1, (k / 24 + 0.5) / 12 - 1, 1, 1, c);
  return sum / 576;
}

}  // namespace

std::vector<Case> factor_cases() {
  const auto nothing = [](SceneBuilder&) {};
  const double round = outline_error(psfs / 2 * 0.2);
  return {
      factor(
          "parallel_squares", "Floor and ceiling of a cube with black walls: F = 0.199825 (Howell, C-11).",
          parallel_squares, at_the_ceiling, [](SceneBuilder& builder) { black_room(builder, "ceiling"); },
          {{{0.02}, {0.02}, {0.002}, {0.001}}}, many_texels),
      factor("parallel_squares_open", "The same without walls: F = 0.199825 (Howell, C-11).", parallel_squares,
             at_the_ceiling, nothing, {{{0.02}, {0.02}, {0.002}, {0.001}}}, many_texels),
      factor(
          "perpendicular_squares", "Floor and wall of a black cube: F = 0.200044 (Howell, C-14).",
          perpendicular_squares,
          [](SceneBuilder& builder, int lamp) {
            builder.quad("lamp", {glm::vec3(-1, 0, 1), {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}}, chart_a, lamp);
          },
          [](SceneBuilder& builder) { black_room(builder, "left"); }, {{{0.02}, {0.02}, {0.004}, {0.001}}},
          many_texels),
      factor(
          "disc_on_its_axis",
          "A disc of radius 1/2 at height 1 in a black cube: F = r^2 / (r^2 + h^2) = 0.2 (Howell, B-12).", 0.2,
          [](SceneBuilder& builder, int lamp) {
            disc(builder, "lamp", {0, 1, 0}, 0.5f, chart_a, lamp);
          },
          [](SceneBuilder& builder) { black_room(builder); }, {{{round, 0.1}, {round}, {0.002}, {0.001}}},
          "the floor is a point, 2 mm wide: nothing averages what the outline leaves to chance, 2 N^-3/4 of N "
          "= 154 directions.",
          1e-3f, silhouettes),
      factor(
          "narrow_gap", "Squares of side 2 at 2 cm, which is half a pixel: F by Howell, B-3, over the floor.",
          opposite_squares(0.02),
          [](SceneBuilder& builder, int lamp) { square(builder, "lamp", 0.02f, true, chart_a, lamp); }, nothing,
          {{{0.015}, {0.015}, {0.002}, {0.001}}},
          "1.5 %: F is 0.99, and what is missing from 1 is lost along the rim, where the gap is open: the next "
          "pixel of the lamp stands in for it."),
  };
}

}  // namespace lichtveld::stability
