// A case of the stability suite: a scene, what is measured on it, what comes out if all is right, and how far
// each method may be from that. All of it is data; stability_test.cpp does the same with every case.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "lichtveld/lightfield/settings.hpp"
#include "texels.hpp"

namespace lichtveld::stability {

using testing::Exact;
using testing::Texel;
using testing::Texels;

enum Method { stencil, list, reference, rays };
inline constexpr std::array method_names = {"thesis (stencil)", "thesis (list)", "reference", "rays"};

// The error is |value / expected - 1|, or |value| where 0 is expected.
struct Limit {
  double tolerance;  // what the method should hold
  // A known failure: it does not hold the tolerance, but what it is off by must stay below this.
  std::optional<double> known = {};
};

struct Figure {
  std::string measured;
  double expected;
  std::function<double(const Texels&)> value;
  std::array<Limit, 4> limits;     // by Method
  std::string reason;              // of the tolerances
  std::string known_failure = "";  // why, and what helps; empty where no limit has a `known`
};

// Several scenes of a case are one row of the table: the one with the largest error counts.
struct Case {
  std::string name;     // letters, digits and _, since it is a test's name too
  std::string formula;  // and where it comes from
  std::function<std::vector<scene::Scene>()> scenes;
  std::uint32_t size, psf, bounces;
  std::uint32_t spp;  // of the reference
  std::vector<Figure> figures;
};

// What gtest says of a case.
inline void PrintTo(const Case& of, std::ostream* out) {
  *out << of.name;
}

// By theme; each in a file of its own.
std::vector<Case> energy_cases();      // closed scenes: what is sent must arrive
std::vector<Case> factor_cases();      // open scenes with a known form factor
std::vector<Case> lamp_cases();        // lamps and openings that get small
std::vector<Case> separation_cases();  // light where there must be none, and layers that must not be lost
std::vector<Case> mesh_cases();        // geometry and atlases as they should not be

// Why stencil routing fails in cases of several themes.
inline constexpr const char* silhouettes =
    "stencil routing takes a layer at its sample's place, not at the pixel's centre that depths are compared "
    "at, so that where an outline crosses a pixel a layer is lost or taken twice (docs/algorithm.md, "
    "Accuracy). The light that it sends is missed then, or what lies behind it is seen in its place. The list "
    "loses none; more pixels (`--psf-size`, `--size`) make silhouettes thinner.";

// A figure that `directions` of a regular set decide: they lie in the lamp's outline as points of a lattice do,
// so that those near the outline, about the root of their number, are in or out by chance, which leaves about
// N^(1/4) of N wrong. Twice that holds for 95 of 100 lamps.
double outline_error(double directions);

}  // namespace lichtveld::stability
