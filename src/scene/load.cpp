// load(): the parts put together.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>

#include "lichtveld/scene/lights.hpp"
#include "load_report.hpp"
#include "model.hpp"
#include "parts.hpp"
#include "skins.hpp"
#include "sky.hpp"

namespace lichtveld::scene {
namespace {

// Scene::bodies and lights.
Owners find_owners(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Scene& scene) {
  Owners owners;
  scene.bodies = {{"standing scene", {}, {}}};
  scene.lights = {{.node = "what does not switch"}};
  for (const PlacedNode& placed : nodes) {
    const glm::vec3 place = placed.world[3];
    if (placed.movable == placed.node) {
      owners.body[placed.node] = static_cast<std::uint32_t>(scene.bodies.size());
      scene.bodies.push_back({node_name(model, placed.node), place, {place, place}});
    }
    if (placed.light == placed.node) {
      owners.light[placed.node] = static_cast<std::uint32_t>(scene.lights.size());
      const std::string name = node_name(model, placed.node);
      auto light =
          light_of(model.nodes[static_cast<std::size_t>(placed.node)].extras, name, "node \"" + name + "\"");
      light.place = place;
      light.body = owners.body.at(placed.movable);
      scene.lights.push_back(std::move(light));
    }
  }
  return owners;
}

void measure_bodies(Scene& scene) {
  std::vector<bool> started(scene.bodies.size());
  for (const Vertex& vertex : scene.vertices) {
    Box& box = scene.bodies[vertex.body].box;
    if (!started[vertex.body]) box = {vertex.position, vertex.position};
    started[vertex.body] = true;
    box = {glm::min(box.min, vertex.position), glm::max(box.max, vertex.position)};
  }
}

// Where lights are that surfaces or punctual lights make up. Those of nothing that shines are remarked on.
void measure_lights(Scene& scene, Remarks& remarks) {
  std::vector<glm::vec3> low(scene.lights.size(), glm::vec3(std::numeric_limits<float>::infinity())),
      high(scene.lights.size(), -low.front());
  const auto add = [&](std::uint32_t light, const glm::vec3& place) {
    low[light] = glm::min(low[light], place);
    high[light] = glm::max(high[light], place);
  };
  for (const auto& surface : scene.surfaces)
    if (scene.materials[surface.material].emission != glm::vec3(0))
      for (std::uint32_t i = 0; i < surface.index_count; ++i)
        add(surface.light, scene.vertices[scene.indices[surface.first_index + i]].position);
  for (const auto& light : scene.punctual)
    if (light.node != sky_name) add(light.light, light.place);
  for (std::size_t light = 1; light < scene.lights.size(); ++light) {
    if (low[light].x <= high[light].x)
      scene.lights[light].place = (low[light] + high[light]) / 2.0f;
    else if (!scene.sky || scene.sky->light != light)
      remarks.add(
          "is to be a light, and nothing of it shines", "node \"" + scene.lights[light].node + '"',
          "give its surfaces an emissiveFactor, or take switchable, flicker and schedule off its extras");
  }
}

struct Piece {
  Surface surface;
  std::vector<std::uint32_t> indices;
  std::vector<glm::vec2> emission_at = {};  // of its vertices, from the first on
  std::uint32_t first_vertex = 0;
};

// Puts even pieces in the place of those whose textures say where they are and where they shine.
std::vector<Piece> cut_uneven(std::vector<Piece> pieces, Materials& materials, Scene& scene) {
  std::size_t triangles = 0;
  for (const auto& piece : pieces)
    if (materials.uneven[piece.surface.material].any()) triangles += piece.indices.size() / 3;
  const int times = cuts_for(triangles);
  std::vector<Piece> result;
  for (auto& piece : pieces) {
    const std::uint32_t slot = piece.surface.material;
    const Uneven uneven = materials.uneven[slot];
    if (!uneven.any()) {
      result.push_back(std::move(piece));
      continue;
    }
    const Material material = materials.materials[slot];
    for (auto& part : cut(material, uneven, piece.indices, piece.emission_at, piece.first_vertex, times,
                          materials.textures, scene.vertices)) {
      Piece even{piece.surface, std::move(part.indices)};
      even.surface.material = static_cast<std::uint32_t>(materials.materials.size());
      materials.materials.push_back(std::move(part.material));
      result.push_back(std::move(even));
    }
  }
  return result;
}

std::vector<Piece> read_pieces(const tinygltf::Model& model, const LoadOptions& options,
                               const Materials& materials, Scene& scene, Oddities& oddities) {
  const std::vector<PlacedNode> nodes = place_nodes(model, options.lights);
  const Owners owners = find_owners(model, nodes, scene);
  scene.punctual = read_lights(model, nodes, owners, options.lumens_per_watt);
  std::vector<Piece> pieces;
  std::size_t triangles_left = max_triangles;
  std::size_t parts_left = max_triangles;  // primitives and morph targets: each takes its time
  SkinReader skins(model, nodes, oddities.remarks);
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh == -1 || !placed.visible) continue;
    const std::string name = node_name(model, placed.node);
    const auto& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
    const auto& primitives = mesh.primitives;
    std::size_t parts = primitives.size();
    for (const auto& primitive : primitives) parts += primitive.targets.size();
    if (parts > parts_left)
      throw SceneError("node \"" + name +
                       "\": the scene has more than 4 million primitives and morph targets; simplify it");
    parts_left -= parts;
    const auto poses =
        node.skin == -1 ? std::span<const glm::dmat4>() : skins.poses(node.skin, "node \"" + name + "\"");
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
      const int material = primitives[i].material;
      if (material < -1 || (material >= 0 && static_cast<std::size_t>(material) >= model.materials.size())) {
        throw SceneError("node \"" + name + "\", primitive " + std::to_string(i) + ": there is no material " +
                         std::to_string(material));
      }
      const std::size_t slot = material < 0 ? model.materials.size() : static_cast<std::size_t>(material);
      const std::uint32_t body = owners.body.at(placed.movable);
      Piece piece{{.node = name,
                   .material = static_cast<std::uint32_t>(slot),
                   .body = body,
                   .light = owners.light.at(placed.light)},
                  {},
                  {},
                  static_cast<std::uint32_t>(scene.vertices.size())};
      const auto& weights = node.weights.empty() ? mesh.weights : node.weights;
      piece.indices = add_primitive(model, primitives[i], {name, i, body, placed.world, weights, poses},
                                    materials.colour[slot], materials.uneven[slot], piece.emission_at,
                                    triangles_left, scene, oddities);
      if (!piece.indices.empty()) pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

// What was counted, before what was remarked on meanwhile.
Remarks remarks_on(const Scene& scene, const Oddities& oddities) {
  Remarks remarks;
  const auto counted = [&](std::size_t count, const char* what, const char* advice) {
    if (count > 0) remarks.add(fmt::format("{} {}", count, what), {}, advice, count);
  };
  counted(oddities.zero_area, "triangles without area were dropped",
          "merge vertices that coincide, and dissolve degenerate faces");
  counted(oddities.zero_chart, "triangles have no area in TEXCOORD_1 and get no texels of their own",
          "give them an area there, or leave TEXCOORD_1 out");
  counted(oddities.outside_atlas, "coordinates of TEXCOORD_1 lie a hair outside 0..1 and were pulled in",
          "nothing, or scale the charts into 0..1");
  counted(oddities.no_triangles, "primitives of points or lines were left out",
          "nothing, or make tubes of lines that should be lit");
  counted(oddities.bad_normals, "primitives have unusable normals; their faces' own are used",
          "compute their normals anew, or export without");
  remarks.append(oddities.remarks);
  if (!has_light(scene))
    remarks.add("nothing emits light; give a material an emissiveFactor, add a light, or try --sky 1,1,1", {},
                "give a material an emissiveFactor, add a light, or try --sky 1,1,1");
  return remarks;
}

// The sky that is asked for, or else the file's, with its suns behind the other lights.
void add_sky(const tinygltf::Model& model, const LoadOptions& options, const std::filesystem::path& folder,
             Scene& scene) {
  auto found = options.sky.empty() ? find_sky(model, scene_of(model), folder) : sky_of(options.sky);
  if (!found) return;
  const auto& extras = model.scenes[static_cast<std::size_t>(scene_of(model))].extras;
  if (are_of_light(extras) || std::ranges::find(options.lights, sky_name) != options.lights.end()) {
    found->sky.light = static_cast<std::uint32_t>(scene.lights.size());
    scene.lights.push_back(light_of(extras, sky_name, "the scene"));
  }
  for (auto& sun : found->suns) {
    sun.light = found->sky.light;
    scene.punctual.push_back(std::move(sun));
  }
  scene.sky = std::move(found->sky);
}

// What each light is, in the file's numbers.
void tell_of_lights(const Scene& scene) {
  using Kind = PunctualLight::Kind;
  constexpr std::size_t most_told = 16;
  if (scene.sky) {
    const glm::vec3 irradiance = irradiance_of(*scene.sky);
    spdlog::info("{}: sky, {:.4g} {:.4g} {:.4g} W/m2 on open ground", scene.file, irradiance.r, irradiance.g,
                 irradiance.b);
  }
  for (std::size_t i = 0; i < std::min(scene.punctual.size(), most_told); ++i) {
    const auto& light = scene.punctual[i];
    const float most = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    if (light.kind == Kind::directional) {
      spdlog::info("{}: directional light \"{}\", {:.4g} W/m2 on what faces it", scene.file, light.node, most);
      continue;
    }
    const glm::vec3 flux = flux_of(light);
    spdlog::info("{}: {} light \"{}\", {:.4g} W/sr, {:.4g} W", scene.file,
                 light.kind == Kind::spot ? "spot" : "point", light.node, most,
                 std::max({flux.r, flux.g, flux.b}));
  }
  if (scene.punctual.size() > most_told)
    spdlog::info("{}: and {} more lights", scene.file, scene.punctual.size() - most_told);
}

// The triangles before textures cut them.
void keep_whole(const std::vector<Piece>& pieces, WholeTriangles& whole) {
  for (const auto& piece : pieces) {
    auto surface = piece.surface;
    surface.first_index = static_cast<std::uint32_t>(whole.indices.size());
    surface.index_count = static_cast<std::uint32_t>(piece.indices.size());
    whole.surfaces.push_back(std::move(surface));
    whole.indices.insert(whole.indices.end(), piece.indices.begin(), piece.indices.end());
  }
}

Scene read_scene(const std::filesystem::path& file, const LoadOptions& options, Oddities& oddities,
                 LoadReport& report) {
  Scene scene;
  scene.file = file.string();
  tinygltf::Model model = read_model(file, oddities.remarks);
  if (report.details) report.details->meshes = mesh_facts(model);
  if (auto unwrapped = unwrap(file, model, options.unwrap)) {
    if (options.unwrap.keep_uv)
      throw SceneError(unwrapped->reason + ": leave out --keep-uv, or give it charts that do not overlap");
    scene.unwrapped = std::move(unwrapped->glb);
    scene.unwrapped_size = unwrapped->size;
    report.unwrapped = std::move(unwrapped);
    Remarks told;  // once is enough
    model = parse_model(scene.unwrapped, file, told);
  }
  if (!options.unwrap.light_map.empty())
    scene.beside = sky_file_of(model.scenes[static_cast<std::size_t>(scene_of(model))].extras);
  Materials materials = read_materials(model);
  std::vector<Piece> pieces = read_pieces(model, options, materials, scene, oddities);
  if (report.details) keep_whole(pieces, report.details->whole);
  pieces = cut_uneven(std::move(pieces), materials, scene);
  scene.materials = std::move(materials.materials);
  scene.textures = std::move(materials.textures);
  if (pieces.empty()) throw SceneError(nothing_to_light);

  const auto one_sided = [&](const Piece& piece) {
    return !scene.materials[piece.surface.material].double_sided;
  };
  const auto double_sided = std::stable_partition(pieces.begin(), pieces.end(), one_sided);
  for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
    if (piece == double_sided) scene.one_sided_indices = static_cast<std::uint32_t>(scene.indices.size());
    piece->surface.first_index = static_cast<std::uint32_t>(scene.indices.size());
    piece->surface.index_count = static_cast<std::uint32_t>(piece->indices.size());
    scene.indices.insert(scene.indices.end(), piece->indices.begin(), piece->indices.end());
    scene.surfaces.push_back(std::move(piece->surface));
  }
  if (double_sided == pieces.end()) scene.one_sided_indices = static_cast<std::uint32_t>(scene.indices.size());
  measure_bodies(scene);
  add_sky(model, options, file.parent_path(), scene);
  measure_lights(scene, oddities.remarks);
  report.remarks = remarks_on(scene, oddities);
  return scene;
}

}  // namespace

Scene load(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report) {
  Oddities oddities;
  try {
    return naming(file, [&] { return read_scene(file, options, oddities, report); });
  } catch (const SceneError&) {
    oddities.remarks.tell(file.string());  // they may be the reason
    throw;
  }
}

Scene load(const std::filesystem::path& file, const LoadOptions& options) {
  LoadReport report;
  Scene scene = load(file, options, report);
  if (report.unwrapped) spdlog::info("{}: {}", scene.file, printable(summary_of(*report.unwrapped)));
  report.remarks.tell(scene.file);
  tell_of_lights(scene);
  return scene;
}

}  // namespace lichtveld::scene
