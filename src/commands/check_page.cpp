// The facts of a scene on one page, for people.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "check.hpp"

namespace lichtveld::commands {

namespace {

using scene::printable;
using Kind = scene::LightFacts::Kind;

constexpr std::size_t most_listed = 12;  // of lights, nodes and findings of a kind: a page is for reading

class Page {
 public:
  void line(const std::string& what, const std::string& text) {
    text_ += fmt::format("   {:<20} {}\n", what, printable(text));
  }
  void title(const std::string& text) { text_ += printable(text) + '\n'; }

  // A line each for the first few, the rest by their number.
  template <typename Each, typename Text>
  void lines(const std::string& what, const Each& all, const Text& text) {
    std::size_t told = 0;
    for (const auto& one : all) {
      if (told == most_listed) return line("", fmt::format("and {} more", std::size(all) - told));
      line(told++ == 0 ? what : "", text(one));
    }
  }

  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

std::string colour(const glm::vec3& value) {
  if (value.r == value.g && value.g == value.b) return fmt::format("{:.4g}", value.r);
  return fmt::format("{:.4g} {:.4g} {:.4g}", value.r, value.g, value.b);
}

void add_contents(const CheckedScene& checked, Page& page) {
  const auto& facts = checked.facts;
  page.line("triangles", fmt::format("{} in {} surfaces, {} materials, {} textures", facts.triangles,
                                     facts.surfaces, facts.materials, facts.textures));
  if (facts.pieces != facts.triangles)
    page.line("", fmt::format("{} pieces once textures have cut them", facts.pieces));
  const glm::vec3 size = facts.box.max - facts.box.min;
  page.line("size",
            fmt::format("{:.4g} x {:.4g} x {:.4g} m, surfaces of {:.4g} m2, in a sphere of radius {:.4g} m",
                        size.x, size.y, size.z, facts.area, facts.sphere.radius));
  page.lines("movable", facts.movable, [](const scene::Body& body) {
    return fmt::format("{} at ({:.3f}, {:.3f}, {:.3f}) m", body.node, body.place.x, body.place.y, body.place.z);
  });
  if (facts.movable.empty()) page.line("movable", "nothing (a node's extras.movable)");
  page.lines("lights", facts.lights, [&](const auto& one) { return line_of(one, checked.lumens_per_watt); });
  if (facts.lights.empty()) page.line("lights", "none");
  page.lines("switchable", facts.switchable, [](const std::string& name) { return name; });
  if (facts.switchable.empty()) page.line("switchable", "no light (a node's extras.switchable)");
}

void add_atlas(const CheckedScene& checked, Page& page) {
  const auto& facts = checked.facts;
  const auto& atlas = facts.atlas;
  page.line("atlas", facts.unwrapped ? scene::summary_of(*facts.unwrapped) : "the file's own TEXCOORD_1");
  page.line(fmt::format("at --size {}", atlas.size),
            fmt::format("{} of {} texels valid, {:.0f} %, in {} charts", atlas.texels,
                        std::uint64_t{atlas.size} * atlas.size, 100 * atlas.coverage(), atlas.charts));
  const auto& density = atlas.texels_per_metre;
  page.line("texels a metre", fmt::format("{:.3g} for half of the area; from {:.3g} to {:.3g}", density.median,
                                          density.min, density.max));
  page.line("without a texel", fmt::format("{} charts, {} triangles, {:.3g} m2", atlas.charts_without_texel,
                                           atlas.triangles_without_texel, atlas.area_without_texel));
  page.line("buried texels",
            checked.texels_buried == 0
                ? "none"
                : fmt::format("{}, inside of what stands there: they take their neighbours' light",
                              checked.texels_buried));
  page.line("shared texels", atlas.shared.texels == 0 ? "none" : text_of(atlas.shared));
}

void add_meshes(const scene::SceneFacts& facts, Page& page) {
  std::size_t open = 0, non_manifold = 0, flipped = 0, inside_out = 0, two_faced = 0;
  double area = 0;
  for (const auto& mesh : facts.meshes) {
    open += mesh.boundary_edges > 0;
    non_manifold += mesh.non_manifold_edges > 0;
    flipped += mesh.flipped_edges > 0;
    inside_out += mesh.inside_out;
    two_faced += mesh.two_faced;
    area += mesh.two_faced_area;
  }
  page.line("meshes", fmt::format("{}: {} open, {} with edges of more than two triangles, {} with faces that "
                                  "disagree",
                                  facts.meshes.size(), open, non_manifold, flipped));
  page.line("", fmt::format("{} closed bodies inside out", inside_out));
  page.line("double-sided",
            fmt::format("{} triangles of which both faces may be seen, {:.3g} m2{}", two_faced, area,
                        facts.unwrapped && two_faced > 0 ? ", a chart for each face" : ""));
}

void add_outlook(const Outlook& outlook, Page& page) {
  if (!outlook.expected) return page.line("a bake", "not foretold: " + outlook.why_not);
  const auto& [quality, error, of_directions, first_ms, step_ms] = *outlook.expected;
  page.line("a bake",
            fmt::format("{:.1f} % off, in {:.2g} s, by --method {} --size {} --psf {} on {}", 100 * error,
                        first_ms / 1000, outlook.method, quality.size, quality.psf, outlook.device));
}

void add_findings(const scene::SceneFacts& facts, Page& page) {
  page.title(facts.findings.empty() ? "nothing to change" : "what to change");
  for (const auto& finding : facts.findings) {
    const bool warning = finding.severity == scene::Finding::Severity::warning;
    page.line(warning ? "warning" : "note", finding.text);
    if (!finding.advice.empty()) page.line("", "-> " + finding.advice);
  }
  if (facts.remarks_left_out > 0) page.line("", fmt::format("and {} more remarks", facts.remarks_left_out));
}

}  // namespace

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::surface:
      return "surface";
    case Kind::point:
      return "point";
    case Kind::spot:
      return "spot";
    case Kind::directional:
      return "directional";
    case Kind::sky:
      return "sky";
  }
  return "";
}

std::string line_of(const scene::LightFacts& facts, double lumens_per_watt) {
  std::string text =
      fmt::format("{} \"{}\"{}: ", name_of(facts.kind), facts.name, facts.switchable ? ", switchable" : "");
  if (facts.kind == Kind::directional) return text + colour(facts.irradiance) + " W/m2 on what faces it";
  if (facts.kind == Kind::sky) return text + colour(facts.irradiance) + " W/m2 on open ground";
  text += colour(facts.flux) + " W";
  if (lumens_per_watt == 1) return text;
  return text + " (" + colour(facts.flux * static_cast<float>(lumens_per_watt)) + " lm)";
}

std::string page_of(const CheckedScene& checked) {
  Page page;
  page.title(checked.file);
  add_contents(checked, page);
  add_atlas(checked, page);
  add_meshes(checked.facts, page);
  add_outlook(checked.outlook, page);
  add_findings(checked.facts, page);
  return std::move(page).text();
}

}  // namespace lichtveld::commands
