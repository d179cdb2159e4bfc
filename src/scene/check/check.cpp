#include "lichtveld/scene/check.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "facts.hpp"
#include "triangle.hpp"

namespace lichtveld::scene {
namespace {

double area_of_all(const Scene& scene, const WholeTriangles& whole) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < whole.indices.size(); i += 3) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene.vertices[whole.indices[i + k]].position;
    area += area_of(corners);
  }
  return area;
}

Box box_of(const Scene& scene) {
  Box box{scene.vertices.front().position, scene.vertices.front().position};
  for (const auto& vertex : scene.vertices)
    box = {glm::min(box.min, vertex.position), glm::max(box.max, vertex.position)};
  return box;
}

}  // namespace

Checked check(const std::filesystem::path& file, const LoadOptions& options) {
  LoadDetails details;
  LoadReport report;
  report.details = &details;
  Checked checked{.scene = load(file, options, report), .facts = {}};
  const Scene& scene = checked.scene;
  const WholeTriangles& whole = details.whole;
  SceneFacts& facts = checked.facts;
  facts.triangles = whole.indices.size() / 3;
  facts.pieces = scene.indices.size() / 3;
  facts.surfaces = whole.surfaces.size();
  std::set<std::uint32_t> materials;
  for (const auto& surface : whole.surfaces) materials.insert(surface.material);
  facts.materials = materials.size();
  facts.textures = scene.textures.size();
  facts.area = area_of_all(scene, whole);
  facts.box = box_of(scene);
  facts.sphere = bounding_sphere(scene);
  facts.movable.assign(scene.bodies.begin() + 1, scene.bodies.end());
  facts.lights = light_facts(scene);
  for (const auto& light : scene.lights)
    if (light.switchable) facts.switchable.push_back(light.node);
  facts.unwrapped = std::move(report.unwrapped);
  facts.atlas = atlas_facts(scene, whole, options.unwrap.size);
  facts.meshes = std::move(details.meshes);
  facts.remarks = report.remarks.all();
  facts.remarks_left_out = report.remarks.left_out();
  for (const auto& remark : facts.remarks)
    facts.findings.push_back(
        {"remark", Finding::Severity::warning, remark.count, text_of(remark), remark.advice});
  for (auto& finding : findings_in(facts)) facts.findings.push_back(std::move(finding));
  std::ranges::stable_sort(facts.findings, std::greater{}, &Finding::severity);
  return checked;
}

}  // namespace lichtveld::scene
