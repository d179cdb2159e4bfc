// The facts of a scene for programs.
#include "check.hpp"

namespace lichtveld::commands {

namespace {

using nlohmann::ordered_json;

ordered_json numbers(const glm::vec3& vector) {
  return {vector.x, vector.y, vector.z};
}

template <typename Each, typename Use>
ordered_json list(const Each& each, const Use& use) {
  ordered_json array = ordered_json::array();
  for (const auto& one : each) array.push_back(use(one));
  return array;
}

ordered_json light(const scene::LightFacts& facts, double lumens_per_watt) {
  using Kind = scene::LightFacts::Kind;
  const bool endless = facts.kind == Kind::directional || facts.kind == Kind::sky;
  ordered_json json = {{"name", facts.name}, {"kind", name_of(facts.kind)}};
  json["flux_w"] = endless ? ordered_json() : numbers(facts.flux);
  if (lumens_per_watt != 1)
    json["flux_lm"] = endless ? ordered_json() : numbers(facts.flux * static_cast<float>(lumens_per_watt));
  json["irradiance_w_m2"] = endless ? numbers(facts.irradiance) : ordered_json();
  json["switchable"] = facts.switchable;
  return json;
}

ordered_json atlas(const scene::AtlasFacts& facts, bool unwrapped) {
  const auto& density = facts.texels_per_metre;
  return {{"source", unwrapped ? "unwrapped" : "file"},
          {"size", facts.size},
          {"texels_valid", facts.texels},
          {"coverage", facts.coverage()},
          {"texels_per_metre", {{"min", density.min}, {"median", density.median}, {"max", density.max}}},
          {"charts", facts.charts},
          {"charts_without_texel", facts.charts_without_texel},
          {"triangles_without_texel", facts.triangles_without_texel},
          {"area_without_texel_m2", facts.area_without_texel},
          {"shared_texels", facts.shared.texels},
          {"shared", list(facts.shared.pairs, [](const auto& pair) {
             return ordered_json{{"nodes", {pair.a, pair.b}}, {"texels", pair.texels}};
           })}};
}

ordered_json mesh(const scene::MeshFacts& facts) {
  return {{"node", facts.node},
          {"nodes", facts.nodes},
          {"triangles", facts.triangles},
          {"double_sided", facts.double_sided},
          {"boundary_edges", facts.boundary_edges},
          {"non_manifold_edges", facts.non_manifold_edges},
          {"flipped_edges", facts.flipped_edges},
          {"closed_bodies", facts.closed_bodies},
          {"inside_out_bodies", facts.inside_out},
          {"two_faced_triangles", facts.two_faced},
          {"two_faced_area_m2", facts.two_faced_area}};
}

ordered_json forecast(const Outlook& outlook) {
  ordered_json json = {{"device", nullptr}, {"method", nullptr},  {"size", nullptr},   {"psf", nullptr},
                       {"error", nullptr},  {"seconds", nullptr}, {"why_not", nullptr}};
  if (!outlook.device.empty()) json["device"] = outlook.device;
  if (!outlook.method.empty()) json["method"] = outlook.method;
  if (!outlook.expected) {
    json["why_not"] = outlook.why_not;
    return json;
  }
  json["size"] = outlook.expected->quality.size;
  json["psf"] = outlook.expected->quality.psf;
  json["error"] = outlook.expected->error;
  json["seconds"] = outlook.expected->first_ms / 1000;
  return json;
}

}  // namespace

nlohmann::ordered_json json_of(const CheckedScene& checked) {
  const auto& facts = checked.facts;
  ordered_json json = {{"file", checked.file}, {"lumens_per_watt", checked.lumens_per_watt}};
  json["geometry"] = {
      {"triangles", facts.triangles},    {"pieces", facts.pieces},          {"surfaces", facts.surfaces},
      {"materials", facts.materials},    {"textures", facts.textures},      {"area_m2", facts.area},
      {"min_m", numbers(facts.box.min)}, {"max_m", numbers(facts.box.max)}, {"radius_m", facts.sphere.radius}};
  json["movable"] = list(facts.movable, [](const scene::Body& body) {
    return ordered_json{{"node", body.node}, {"place_m", numbers(body.place)}};
  });
  json["switchable"] = facts.switchable;
  json["lights"] = list(facts.lights, [&](const auto& one) { return light(one, checked.lumens_per_watt); });
  json["atlas"] = atlas(facts.atlas, facts.unwrapped.has_value());
  json["atlas"]["texels_buried"] = checked.texels_buried;
  json["unwrapped"] = nullptr;
  if (const auto& unwrapped = facts.unwrapped)
    json["unwrapped"] = {{"reason", unwrapped->reason},
                         {"size", unwrapped->size},
                         {"charts", unwrapped->charts},
                         {"texels_per_metre", unwrapped->texels_per_metre},
                         {"coverage", unwrapped->coverage}};
  json["meshes"] = list(facts.meshes, mesh);
  json["remarks"] = list(facts.remarks, [](const scene::Remark& remark) {
    return ordered_json{{"text", scene::text_of(remark)}, {"count", remark.count}, {"advice", remark.advice}};
  });
  json["remarks_left_out"] = facts.remarks_left_out;
  json["forecast"] = forecast(checked.outlook);
  json["findings"] = list(facts.findings, [](const scene::Finding& finding) {
    const bool warning = finding.severity == scene::Finding::Severity::warning;
    return ordered_json{{"id", finding.id},
                        {"severity", warning ? "warning" : "note"},
                        {"count", finding.count},
                        {"text", finding.text},
                        {"advice", finding.advice}};
  });
  return json;
}

}  // namespace lichtveld::commands
