// Closed scenes: what is sent must arrive, once.
#include "known_scenes.hpp"
#include "shapes.hpp"
#include "stability_case.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

double geometric_sum(double albedo, unsigned bounces) {
  return (1 - std::pow(albedo, bounces)) / (1 - albedo);
}

Case furnace_of(const std::string& name, double albedo, unsigned bounces) {
  const double exact = pi * geometric_sum(albedo, bounces);
  return {
      .name = name,
      .formula =
          "A closed room of one albedo and one emission: E = pi Le (1 - rho^n) / (1 - rho), the sum of a "
          "geometric series (the Neumann series of Kajiya 1986, \"The Rendering Equation\", with one albedo).",
      .scenes = [=] { return std::vector{furnace(static_cast<float>(albedo))}; },
      .size = 64,
      .psf = 96,
      .bounces = bounces,
      .spp = 64,
      .figures = {
          {"mean E",
           exact,
           [](const Texels& map) { return mean(map); },
           {{{0.015}, {1e-4}, {0.005}, {1e-4}}},
           "rows of the transport sum to one, so that the list owes rounding alone; the stencil's silhouettes "
           "are 1 pixel of 18 across a wall, and lose a part of them; the reference has noise."},
          {"share of texels over 1 % off",
           0,
           [=](const Texels& map) {
             return share_off(
                 map, [=](const Texel&) { return exact; }, 0.01);
           },
           {{{0.01, 0.12}, {0.01}, {0.01}, {0.01}}},
           "rows sum to one whatever is seen, so that nothing but a lost ray can spoil a texel: under 1 % of "
           "them may have one. The reference's own noise is taken off first.",
           silhouettes}}};
}

Case radiance_of(const std::string& name, float emission) {
  return {.name = name,
          .formula = "The furnace of albedo 0.5 at the ends of what lamps send: E is linear in Le.",
          .scenes = [=] { return std::vector{furnace(0.5f, emission)}; },
          .size = 32,
          .psf = 24,
          .bounces = 3,
          .spp = 64,
          .figures = {{"mean E",
                       pi * emission * geometric_sum(0.5, 3),
                       [](const Texels& map) { return mean(map); },
                       {{{0.02}, {1e-4}, {0.01}, {1e-4}}},
                       "32-bit floats scale without loss; otherwise as the furnace, with half the pixels."}}};
}

double area_of(const scene::Scene& scene, const std::string& node) {
  double area = 0;
  for (const auto& surface : scene.surfaces)
    for (auto i = surface.first_index; surface.node == node && i < surface.first_index + surface.index_count;
         i += 3) {
      const auto corner = [&](std::uint32_t k) {
        return glm::dvec3(scene.vertices[scene.indices[i + k]].position);
      };
      area += glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
    }
  return area;
}

// In a sphere every point sees every other alike (dF = dA / 4 pi R^2), so that E is even. Of the faceted sphere
// that stands for it this holds of E's mean over the area, exactly: what is sent arrives, and all of it meets
// one albedo.
Case integrating_sphere() {
  const auto scene = [] {
    SceneBuilder builder;
    sphere(builder, "sphere", 1, 14, true, whole_atlas, builder.material(glm::vec3(0.8f)),
           builder.material(glm::vec3(0.8f), glm::vec3(10)));
    return loaded(builder);
  };
  constexpr unsigned bounces = 6;
  const auto faceted = scene();
  const double cap = area_of(faceted, "sphere's cap"), all = cap + area_of(faceted, "sphere");
  const double exact = pi * 10 * cap / all * geometric_sum(0.8, bounces);
  return {
      .name = "integrating_sphere",
      .formula =
          "A sphere of albedo 0.8, 1.4 % of which glows: E = Phi / (4 pi R^2) (1 - rho^n) / (1 - rho) (Jacquez "
          "and Kuppenheim 1955, \"Theory of the Integrating Sphere\"), 4 pi R^2 being the area of the facets.",
      .scenes = [=] { return std::vector{scene()}; },
      .size = 96,
      .psf = 384,
      .bounces = bounces,
      .spp = 64,
      .figures = {
          {"mean E over the area",
           exact,
           [](const Texels& map) { return mean(map); },
           {{{0.02, 0.05}, {0.02}, {0.01}, {0.001}}},
           "2 %: a row of the transport is divided by its own weights, so that rows sum to one but columns do "
           "not quite: what arrives from the cap is what the directions from there happen to carry.",
           silhouettes},
          {"rel_rmse",
           0,
           [=](const Texels& map) { return rel_rmse(map, [=](const Texel&) { return exact; }); },
           {{{0.05, 0.25}, {0.05, 0.25}, {0.05}, {0.05}}},
           "5 %, as the Cornell room has at 384 PSFs; that the sphere has facets makes 2 %.",
           "the cap is a small lamp: 3 of a texel's 192 directions hit it. More `--psf`."}}};
}

Case concentric_spheres() {
  const auto scene = [] {
    SceneBuilder builder;
    sphere(builder, "outer", 1, 7, true, {0, 0, 0.5f, 0.5f},
           builder.material(glm::vec3(0), glm::vec3(0, 0, 5)));
    sphere(builder, "inner", 0.5f, 7, false, {0.5f, 0.5f, 1, 1},
           builder.material(glm::vec3(0), glm::vec3(10, 0, 0)));
    return loaded(builder);
  };
  const auto faceted = scene();
  const double seen = area_of(faceted, "inner") / area_of(faceted, "outer");
  return {.name = "concentric_spheres",
          .formula =
              "A black sphere of radius 1 sends blue, one of radius 1/2 in it sends red: F(inner, outer) = 1, "
              "F(outer, inner) = A(inner) / A(outer) by reciprocity, and the outer sees itself for the rest "
              "(Howell 1982, the introduction's factor algebra). True of facets too, as means over the area.",
          .scenes = [=] { return std::vector{scene()}; },
          .size = 96,
          .psf = 384,
          .bounces = 1,
          .spp = 64,
          .figures = {{"inner, from outer",
                       pi * 5,
                       [](const Texels& map) { return mean(of(map, "inner"), 2); },
                       {{{0.015}, {1e-3}, {0.001}, {1e-3}}},
                       "all that the inner sphere sees glows: rows sum to one, as in the furnace. But near the "
                       "edge of a facet a pixel's centre can see the next facet, in grazing directions, which "
                       "carry 1e-3 of the light at most."},
                      {"outer, from inner",
                       pi * 10 * seen,
                       [](const Texels& map) { return mean(of(map, "outer"), 0); },
                       {{{0.02}, {0.01}, {0.01}, {0.01}}},
                       "the outline of the inner sphere holds 96 of 384 directions, and is averaged over 1000 "
                       "texels; of its 20 pixels across, one is silhouette."},
                      {"outer, from itself",
                       pi * 5 * (1 - seen),
                       [](const Texels& map) { return mean(of(map, "outer"), 2); },
                       {{{0.02}, {0.01}, {0.01}, {0.01}}},
                       "the rest of the same."}}};
}

}  // namespace

std::vector<Case> energy_cases() {
  return {furnace_of("furnace_0_2", 0.2, 3),
          furnace_of("furnace_0_5", 0.5, 4),
          furnace_of("furnace_0_9", 0.9, 8),
          radiance_of("radiance_1e_minus_6", 1e-6f),
          radiance_of("radiance_1e_plus_6", 1e6f),
          integrating_sphere(),
          concentric_spheres()};
}

}  // namespace lichtveld::stability
