#include "lichtveld/scene/unwrap.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "accessor.hpp"
#include "charts.hpp"
#include "flat_triangle.hpp"
#include "model.hpp"
#include "pack.hpp"
#include "parts.hpp"
#include "plain_file.hpp"
#include "skins.hpp"
#include "sky.hpp"
#include "vertices.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

constexpr std::uint32_t largest_atlas = 4096;
constexpr std::uint32_t gutter = 2;  // texels between charts

// Whether an atlas is used as it is must not depend on the size that is baked: it is looked at on this raster.
constexpr std::uint32_t judged_at = 512;
constexpr double most_overlap = 0.005;  // of the cells that charts fill
constexpr double most_flat = 0.5;       // of the surfaces' area, that has none in the atlas

// Texels of an atlas are filled by about so large a share, and two cells lie in one along each axis.
constexpr double usual_fill = 0.6, cells_in_texel = 2;
// Of larger atlases no smaller cells are looked at.
constexpr std::uint32_t finest_cells = 512;

// A primitive of a mesh that is laid flat.
struct Sheet {
  std::size_t primitive = 0;  // in the mesh
  std::string what;           // for messages
  bool double_sided = false;
  std::vector<Triangle> triangles;            // elements of its accessors
  std::vector<Corners> corners;               // of each triangle, in the mesh's space
  std::size_t fronts = 0;                     // the triangles behind these are backs of some
  std::vector<std::array<glm::vec2, 3>> own;  // of each triangle, where it has a usable TEXCOORD_1
  std::vector<Chart> charts;
};

struct Use {
  int node = 0;
  std::string name;
  glm::dmat4 world{1};
  double density = 1;         // extras.texels
  std::vector<double> posed;  // of a skin: the area of each sheet [m2]
};

// A mesh, and the nodes of the scene that show it.
struct UsedMesh {
  std::vector<Sheet> sheets;
  std::vector<Use> uses;
};

using Meshes = std::map<int, UsedMesh>;

std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

int attribute_of(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

// The triangle's coordinates, or nothing where the primitive has none that can be read.
std::vector<std::array<glm::vec2, 3>> own_atlas(const tinygltf::Model& model,
                                                const tinygltf::Primitive& primitive, const Sheet& sheet,
                                                std::size_t vertices) {
  const int index = attribute_of(primitive, "TEXCOORD_1");
  if (index < 0) return {};
  const Accessor atlas(model, index, sheet.what + ", TEXCOORD_1");
  atlas.require_vectors(2);
  if (atlas.count() < vertices) return {};
  std::vector<std::array<glm::vec2, 3>> own;
  for (const auto& t : sheet.triangles) own.push_back({atlas.vec2(t[0]), atlas.vec2(t[1]), atlas.vec2(t[2])});
  return own;
}

// The sheets of a mesh in the shape that a node gives it by its weights.
std::vector<Sheet> sheets_of(const tinygltf::Model& model, int mesh, const std::string& name,
                             std::span<const double> weights, std::size_t& triangles_left) {
  const auto& primitives = model.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::vector<Sheet> sheets;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const auto& primitive = primitives[i];
    Sheet sheet;
    sheet.primitive = i;
    sheet.what = "node " + in_quotes(name) + ", primitive " + std::to_string(i);
    auto triangles = triangles_of(model, primitive, triangles_left, sheet.what);
    if (!triangles) continue;
    const Vertices vertices(model, primitive, {.node = name, .weights = weights}, sheet.what);
    sheet.double_sided = primitive.material >= 0 &&
                         static_cast<std::size_t>(primitive.material) < model.materials.size() &&
                         model.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
    sheet.triangles = std::move(*triangles);
    sheet.fronts = sheet.triangles.size();
    for (const auto& t : sheet.triangles)
      sheet.corners.push_back({vertices.position(t[0]), vertices.position(t[1]), vertices.position(t[2])});
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const auto& place = sheet.corners[t][k]; !std::isfinite(place.x + place.y + place.z))
          check_place(place, sheet.triangles[t][k], sheet.what);
    sheet.own = own_atlas(model, primitive, sheet, vertices.count());
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

double density_of(const tinygltf::Node& node, const std::string& name) {
  if (!node.extras.IsObject() || !node.extras.Has("texels")) return 1;
  const auto& value = node.extras.Get("texels");
  const double density = value.IsNumber() ? value.GetNumberAsDouble() : 0;
  if (!(density >= 0.01 && density <= 100))
    throw SceneError("node \"" + name + "\": extras.texels is no number of 0.01..100");
  return density;
}

Corners in_world(const Corners& corners, const glm::dmat4& world) {
  Corners result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = glm::vec3(world * glm::dvec4(corners[k], 1));
  return result;
}

// The area of each sheet as a skin's joints show it.
std::vector<double> posed_areas(const tinygltf::Model& model, const UsedMesh& mesh, int number, const Use& use,
                                std::span<const glm::dmat4> poses, std::span<const double> weights) {
  std::vector<double> areas;
  const auto& primitives = model.meshes[static_cast<std::size_t>(number)].primitives;
  for (const auto& sheet : mesh.sheets) {
    const Vertices vertices(model, primitives[sheet.primitive],
                            {.node = use.name, .world = use.world, .weights = weights, .poses = poses},
                            sheet.what);
    double area = 0;
    for (const auto& triangle : sheet.triangles) {
      Corners corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] =
            glm::vec3(vertices.transform(triangle[k]).world * glm::dvec4(vertices.position(triangle[k]), 1));
      area += area_of(corners);
    }
    areas.push_back(area);
  }
  return areas;
}

Meshes used_meshes(const tinygltf::Model& model) {
  Meshes meshes;
  std::size_t triangles_left = max_triangles;
  const auto nodes = place_nodes(model, {});
  Remarks remarks;  // load() tells them
  SkinReader skins(model, nodes, remarks);
  for (const PlacedNode& placed : nodes) {
    const auto& node = model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) continue;
    const std::string name = node_name(model, placed.node);
    const auto& weights =
        node.weights.empty() ? model.meshes[static_cast<std::size_t>(node.mesh)].weights : node.weights;
    auto& mesh = meshes[node.mesh];
    if (mesh.uses.empty()) mesh.sheets = sheets_of(model, node.mesh, name, weights, triangles_left);
    mesh.uses.push_back({placed.node, name, placed.world, density_of(node, name), {}});
    if (node.skin < 0) continue;
    if (const auto poses = skins.poses(node.skin, "node " + in_quotes(name)); !poses.empty())
      mesh.uses.back().posed = posed_areas(model, mesh, node.mesh, mesh.uses.back(), poses, weights);
  }
  return meshes;
}

// The area of a sheet of the mesh as the node shows it [m2].
double area_in_world(const UsedMesh& mesh, std::size_t sheet, const Use& use) {
  const Sheet& of = mesh.sheets[sheet];
  if (!use.posed.empty())  // its backs are as large
    return use.posed[sheet] * static_cast<double>(of.corners.size()) / static_cast<double>(of.fronts);
  double area = 0;
  for (const auto& corners : of.corners) area += area_of(in_world(corners, use.world));
  return area;
}

// By how much longer things are in the world than in the mesh, for a sheet as a whole, times the node's
// density.
double scale_of(const UsedMesh& mesh, std::size_t sheet, const Use& use) {
  double inside = 0;
  for (const auto& corners : mesh.sheets[sheet].corners) inside += area_of(corners);
  const double scale = std::sqrt(area_in_world(mesh, sheet, use) / inside) * use.density;
  return std::isfinite(scale) ? scale : 0;
}

// Why the scene's own atlas cannot be used, or nothing.
std::string fault_of(const Meshes& meshes) {
  std::vector<std::string> without;
  for (const auto& [number, mesh] : meshes)
    for (const auto& sheet : mesh.sheets)
      if (sheet.own.empty()) {
        without.push_back(mesh.uses.front().name);
        break;
      }
  if (!without.empty())
    return "node " + in_quotes(without.front()) +
           (without.size() > 1 ? " and " + std::to_string(without.size() - 1) + " more have" : " has") +
           " no TEXCOORD_1";
  struct Owner {
    const Corners* corners = nullptr;
    const Use* use = nullptr;
  };
  std::vector<Owner> owners(std::size_t{judged_at} * judged_at);
  std::size_t filled = 0, shared = 0;
  double area = 0, flat_area = 0;
  std::map<std::pair<std::string, std::string>, std::size_t> pairs;
  std::string flattest;
  for (const auto& [number, mesh] : meshes)
    for (const auto& use : mesh.uses)
      for (const auto& sheet : mesh.sheets)
        for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
          std::array<glm::dvec2, 3> cells;
          for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec2 at = sheet.own[t][k];
            if (!(glm::distance(at, glm::clamp(at, 0.0f, 1.0f)) <= atlas_rounding))
              return "TEXCOORD_1 of node " + in_quotes(use.name) + " is not within 0..1";
            cells[k] = glm::dvec2(at) * double{judged_at};
          }
          const double of_triangle = area_of(in_world(sheet.corners[t], use.world));
          area += of_triangle;
          const auto flat = FlatTriangle::of(cells);
          if (!flat) {
            flat_area += of_triangle;
            flattest = use.name;
            continue;
          }
          // A texel's hair is nobody's: charts may touch.
          constexpr double margin = 0.05;
          flat->for_cells(margin, judged_at, [&](std::int64_t i, std::int64_t j) {
            Owner& owner = owners[static_cast<std::size_t>(j * judged_at + i)];
            if (!owner.corners) {
              ++filled;
            } else if (owner.use != &use || *owner.corners != sheet.corners[t]) {
              ++shared;
              ++pairs[std::minmax(owner.use->name, use.name)];
            }
            owner = {&sheet.corners[t], &use};
          });
        }
  if (flat_area > most_flat * area) return "TEXCOORD_1 of node " + in_quotes(flattest) + " has no area";
  if (static_cast<double>(shared) > most_overlap * static_cast<double>(filled)) {
    const auto worst = std::ranges::max_element(pairs, {}, [](const auto& pair) { return pair.second; })->first;
    return worst.first == worst.second ? "charts of node " + in_quotes(worst.first) + " overlap in TEXCOORD_1"
                                       : "charts of nodes " + in_quotes(worst.first) + " and " +
                                             in_quotes(worst.second) + " overlap in TEXCOORD_1";
  }
  return "";
}

// Which bodies of these are seen from outside alone: closed, and nothing of the scene lies within their box.
class Solids {
 public:
  explicit Solids(const Meshes& meshes) {
    std::vector<Point> points;
    for (const auto& [number, mesh] : meshes) {
      std::vector<Corners> all;
      for (const auto& sheet : mesh.sheets) all.insert(all.end(), sheet.corners.begin(), sheet.corners.end());
      bodies_[number] = find_bodies(all);
      const auto& bodies = bodies_[number];
      for (const auto& use : mesh.uses)
        for (std::size_t body = 0; body < bodies.closed.size(); ++body)
          points.push_back(point((use.world * glm::dvec4((bodies.min[body] + bodies.max[body]) / 2.0f, 1))));
    }
    const boost::geometry::index::rtree<Point, boost::geometry::index::rstar<16>> tree(points);
    for (const auto& [number, mesh] : meshes) {
      auto& bodies = bodies_[number];
      for (const auto& use : mesh.uses)
        for (std::size_t body = 0; body < bodies.closed.size(); ++body) {
          if (!bodies.closed[body]) continue;
          glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
          for (unsigned corner = 0; corner < 8; ++corner) {
            glm::dvec4 at(0, 0, 0, 1);
            for (unsigned axis = 0; axis < 3; ++axis)
              at[static_cast<int>(axis)] =
                  (corner >> axis & 1 ? bodies.max : bodies.min)[body][static_cast<int>(axis)];
            const glm::dvec3 place = use.world * at;
            low = glm::min(low, place);
            high = glm::max(high, place);
          }
          const Box box(point(low), point(high));
          std::size_t inside = 0;
          for (auto found = tree.qbegin(boost::geometry::index::within(box));
               found != tree.qend() && inside < 2; ++found)
            ++inside;
          if (inside > 1) bodies.closed[body] = false;  // more than its own middle
        }
    }
  }

  // Whether a triangle, counted over all sheets of the mesh, is of such a body.
  bool has(int mesh, std::size_t triangle) const {
    const auto& bodies = bodies_.at(mesh);
    return bodies.closed[bodies.of[triangle]];
  }

 private:
  using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Box = boost::geometry::model::box<Point>;
  static Point point(const glm::dvec3& at) { return {at.x, at.y, at.z}; }

  std::map<int, Bodies> bodies_;
};

// Gives double-sided surfaces backs of their own, where they may be seen.
void add_backs(Meshes& meshes) {
  const bool any = std::ranges::any_of(
      meshes, [](const auto& entry) { return std::ranges::any_of(entry.second.sheets, &Sheet::double_sided); });
  if (!any) return;
  const Solids solids(meshes);
  for (auto& [number, mesh] : meshes) {
    std::size_t first = 0;
    for (auto& sheet : mesh.sheets) {
      for (std::size_t t = 0; t < sheet.fronts && sheet.double_sided; ++t) {
        if (solids.has(number, first + t)) continue;
        const auto [a, b, c] = sheet.triangles[t];
        const auto& at = sheet.corners[t];
        sheet.corners.push_back({at[0], at[2], at[1]});
        sheet.triangles.push_back({a, c, b});
      }
      first += sheet.fronts;
    }
  }
}

// Charts of all sheets; the number of triangles of their own charts that could not be kept.
std::size_t lay_flat(Meshes& meshes, std::uint32_t size) {
  double area = 0;
  for (const auto& [number, mesh] : meshes)
    for (std::size_t s = 0; s < mesh.sheets.size(); ++s)
      for (const auto& use : mesh.uses) area += area_in_world(mesh, s, use) * use.density * use.density;
  const double side = std::sqrt(area / usual_fill);  // of the atlas [m]
  std::size_t anew = 0;
  for (auto& [number, mesh] : meshes)
    for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
      Sheet& sheet = mesh.sheets[s];
      double scale = 0;
      for (const auto& use : mesh.uses) scale = std::max(scale, scale_of(mesh, s, use));
      if (!(scale > 0)) continue;
      const ChartLimits limits{.cell = side / std::min(size, finest_cells) / cells_in_texel / scale,
                               .longest = side / scale};
      const std::span<const Corners> fronts(sheet.corners.data(), sheet.fronts);
      if (sheet.own.empty()) {
        sheet.charts = find_charts(sheet.corners, limits);
        continue;
      }
      sheet.charts = charts_of(fronts, sheet.own, limits, anew);
      for (auto& chart : find_charts(std::span(sheet.corners).subspan(sheet.fronts), limits)) {
        for (auto& t : chart.triangles) t += static_cast<std::uint32_t>(sheet.fronts);
        sheet.charts.push_back(std::move(chart));
      }
    }
  return anew;
}

// A chart of a node in the atlas.
struct Spot {
  const Chart* chart = nullptr;
  double scale = 0;  // from the mesh's metres to the node's, times its density
};

struct Atlas {
  std::uint32_t size = 0;
  double density = 0;                 // texels a metre
  std::vector<Rectangle> rectangles;  // of each spot, with its gutter
};

std::vector<Rectangle> rectangles_of(const std::vector<Spot>& spots, double density, std::uint32_t size) {
  std::vector<Rectangle> rectangles;
  const auto texels = [&](double metres) {
    const double wanted = std::round(metres * density);
    return static_cast<std::uint32_t>(std::clamp(wanted, 1.0, 2.0 * size)) + gutter;
  };
  for (const auto& spot : spots)
    rectangles.push_back(
        {texels(spot.chart->extent.x * spot.scale), texels(spot.chart->extent.y * spot.scale)});
  return rectangles;
}

bool fit(const std::vector<Spot>& spots, double density, Atlas& atlas) {
  auto rectangles = rectangles_of(spots, density, atlas.size);
  if (!pack(rectangles, atlas.size)) return false;
  atlas.density = density;
  atlas.rectangles = std::move(rectangles);
  return true;
}

// The smallest atlas from `options.size` on that holds all charts, as dense as can be or as is wanted.
Atlas packed(const std::vector<Spot>& spots, const UnwrapOptions& options) {
  double longest = 0;
  for (const auto& spot : spots)
    longest = std::max({longest, spot.chart->extent.x * spot.scale, spot.chart->extent.y * spot.scale});
  for (Atlas atlas{.size = options.size, .density = 0, .rectangles = {}}; atlas.size <= largest_atlas;
       atlas.size *= 2) {
    if (options.texels_per_metre > 0) {
      if (fit(spots, options.texels_per_metre, atlas)) return atlas;
      continue;
    }
    double low = 0, high = atlas.size / longest;
    if (!fit(spots, low, atlas)) continue;
    constexpr int steps = 20;
    for (int step = 0; step < steps; ++step) {
      const double middle = (low + high) / 2;
      (fit(spots, middle, atlas) ? low : high) = middle;
    }
    return atlas;
  }
  throw SceneError("its " + std::to_string(spots.size()) + " charts find no room in an atlas of " +
                   std::to_string(largest_atlas) + " x " + std::to_string(largest_atlas) +
                   " texels: simplify it" +
                   (options.texels_per_metre > 0 ? ", or ask for fewer texels a metre" : ""));
}

// A place of a chart in the atlas, 0..1. One that is only a texel wide or high is moved, into its gutter if
// need be, so that the middle of its first triangle, its largest, lies on texels' centres: it would hold none
// otherwise.
glm::vec2 in_atlas(const Chart& chart, const Rectangle& rectangle, const glm::dvec2& place,
                   std::uint32_t size) {
  const glm::dvec2 texels(rectangle.width - gutter, rectangle.height - gutter);
  const glm::dvec2 corner = glm::dvec2(rectangle.x, rectangle.y) + double{gutter} / 2;
  glm::dvec2 share(0.5);
  for (int axis = 0; axis < 2; ++axis)
    if (chart.extent[axis] > 0) {
      share[axis] = place[axis] / chart.extent[axis];
      if (texels[axis] <= 1)
        share[axis] += 0.5 - (chart.flat[0][0][axis] + chart.flat[0][1][axis] + chart.flat[0][2][axis]) / 3 /
                                 chart.extent[axis];
    }
  return (corner + share * texels) / static_cast<double>(size);
}

// What textures use TEXCOORD_1 for moves to a set that nobody has; its number, or nothing.
std::optional<int> move_texture_set(json& root) {
  bool used = false;
  int set = 0;
  const std::function<void(json&, bool)> walk = [&](json& value, bool change) {
    if (value.is_object() && value.contains("texCoord") && value["texCoord"] == 1) {
      used = true;
      if (change) value["texCoord"] = set;
    }
    if (value.is_structured())
      for (auto& inner : value) walk(inner, change);
  };
  if (!root.contains("materials")) return std::nullopt;
  walk(root["materials"], false);
  if (!used) return std::nullopt;
  for (const auto& mesh : root["meshes"])
    for (const auto& primitive : mesh["primitives"])
      while (primitive["attributes"].contains("TEXCOORD_" + std::to_string(std::max(set, 2)))) ++set;
  set = std::max(set, 2);
  walk(root["materials"], true);
  return set;
}

// The number of the material as one that has a front alone.
class OneSided {
 public:
  explicit OneSided(json& root) : root_(root) {}
  int of(int material) {
    if (const auto known = twins_.find(material); known != twins_.end()) return known->second;
    json twin = root_["materials"].at(static_cast<std::size_t>(material));
    twin["doubleSided"] = false;
    root_["materials"].push_back(std::move(twin));
    return twins_[material] = static_cast<int>(root_["materials"].size()) - 1;
  }

 private:
  json& root_;
  std::map<int, int> twins_;
};

// The vertices of a sheet once its charts have come apart.
struct Split {
  std::vector<std::uint32_t> elements;                     // of the file's accessors, one a vertex
  std::vector<bool> back;                                  // of each vertex
  std::vector<std::pair<std::uint32_t, glm::dvec2>> flat;  // of each vertex: its chart, and where in it
  std::vector<std::uint32_t> indices;
};

Split split_of(const Sheet& sheet) {
  constexpr std::uint32_t none = ~0u;
  struct Key {
    std::uint32_t element, chart;
    double x, y;
    bool back;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<std::pair<std::uint32_t, std::array<glm::dvec2, 3>>> flat(sheet.triangles.size(), {none, {}});
  for (std::uint32_t c = 0; c < sheet.charts.size(); ++c)
    for (std::size_t i = 0; i < sheet.charts[c].triangles.size(); ++i)
      flat[sheet.charts[c].triangles[i]] = {c, sheet.charts[c].flat[i]};
  std::map<Key, std::uint32_t> known;
  Split split;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [chart, corners] = flat[t];
      const bool back = t >= sheet.fronts;
      const Key key{sheet.triangles[t][k], chart, corners[k].x, corners[k].y, back};
      const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(split.elements.size()));
      split.indices.push_back(found->second);
      if (!is_new) continue;
      split.elements.push_back(key.element);
      split.back.push_back(back);
      split.flat.emplace_back(chart, corners[k]);
    }
  return split;
}

class Writer {
 public:
  Writer(json root, const tinygltf::Model& model)
      : model_(model),
        moved_set_(move_texture_set(root)),
        file_(std::move(root), model),
        one_sided_(file_.root()) {}

  // Adds a mesh for each of its uses, whose spots are the next of `spot`.
  void add(int number, const UsedMesh& mesh, const Atlas& atlas, std::size_t& spot) {
    std::vector<Split> splits;
    std::vector<json> primitives;
    for (const auto& sheet : mesh.sheets) {
      splits.push_back(split_of(sheet));
      primitives.push_back(primitive_of(number, sheet, splits.back()));
    }
    for (const auto& use : mesh.uses) {
      json out = file_.root()["meshes"][static_cast<std::size_t>(number)];
      out["primitives"] = json::array();
      for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
        const auto& sheet = mesh.sheets[s];
        std::vector<float> numbers;
        for (const auto& [chart, place] : splits[s].flat) {
          glm::vec2 at(0);
          if (chart < sheet.charts.size())
            at = in_atlas(sheet.charts[chart], atlas.rectangles[spot + chart], place, atlas.size);
          numbers.push_back(at.x);
          numbers.push_back(at.y);
        }
        spot += sheet.charts.size();
        json primitive = primitives[s];
        auto& attributes = primitive["attributes"];
        attributes["TEXCOORD_1"] = file_.add_vec2(numbers);
        // Sets are counted from 0 without gaps.
        for (int set = 0; moved_set_ && set < *moved_set_; ++set) fill_set(attributes, set);
        fill_set(attributes, 0);
        out["primitives"].push_back(std::move(primitive));
      }
      file_.show(static_cast<std::size_t>(use.node), file_.add_mesh(std::move(out)));
    }
  }

  std::vector<std::uint8_t> finish() { return file_.finish(); }

 private:
  static void fill_set(json& attributes, int set) {
    const std::string name = "TEXCOORD_" + std::to_string(set);
    if (!attributes.contains(name)) attributes[name] = attributes["TEXCOORD_1"];
  }

  json primitive_of(int mesh, const Sheet& sheet, const Split& split) {
    const auto& in = model_.meshes[static_cast<std::size_t>(mesh)].primitives[sheet.primitive];
    json out = without_compression(
        file_.root()["meshes"][static_cast<std::size_t>(mesh)]["primitives"][sheet.primitive]);
    const auto vertices = [&](const std::string& semantic, int accessor) {
      return semantic == "NORMAL" ? normals_of(accessor, split)
                                  : file_.chosen(accessor, split.elements, semantic);
    };
    out["mode"] = TINYGLTF_MODE_TRIANGLES;
    out["attributes"] = json::object();
    for (const auto& [semantic, accessor] : in.attributes) {
      if (semantic == "TEXCOORD_1" && !moved_set_) continue;
      const std::string name = semantic == "TEXCOORD_1" ? "TEXCOORD_" + std::to_string(*moved_set_) : semantic;
      out["attributes"][name] = vertices(semantic, accessor);
    }
    for (std::size_t t = 0; t < in.targets.size(); ++t)
      for (const auto& [semantic, accessor] : in.targets[t])
        out["targets"][t][semantic] = vertices(semantic, accessor);
    out["indices"] = file_.add_indices(split.indices);
    if (sheet.double_sided) out["material"] = one_sided_.of(in.material);
    return out;
  }

  // Those of backs point the other way.
  int normals_of(int accessor, const Split& split) {
    if (std::ranges::none_of(split.back, std::identity{}))
      return file_.chosen(accessor, split.elements, "NORMAL");
    const Accessor normals(model_, accessor, "NORMAL");
    normals.require_vectors(3);
    std::vector<float> numbers;
    for (std::size_t i = 0; i < split.elements.size(); ++i) {
      if (split.elements[i] >= normals.count()) throw SceneError("NORMAL has fewer elements than POSITION");
      const glm::vec3 normal = normals.vec3(split.elements[i]) * (split.back[i] ? -1.0f : 1.0f);
      numbers.insert(numbers.end(), {normal.x, normal.y, normal.z});
    }
    return file_.add_vec3(numbers);
  }

  const tinygltf::Model& model_;
  std::optional<int> moved_set_;
  PlainFile file_;
  OneSided one_sided_;
};

}  // namespace

std::optional<Unwrapped> unwrap(const std::filesystem::path& file, const tinygltf::Model& model,
                                const UnwrapOptions& options) {
  Meshes meshes = used_meshes(model);
  Unwrapped result;
  result.reason = fault_of(meshes);
  if (result.reason.empty()) return std::nullopt;
  add_backs(meshes);
  const std::size_t anew = lay_flat(meshes, options.size);
  if (anew > 0)
    result.reason +=
        "; " + std::to_string(anew) + " triangles of its charts fold or have no area, and are laid anew";
  std::vector<Spot> spots;
  for (const auto& [number, mesh] : meshes)
    for (const auto& use : mesh.uses)
      for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
        const double scale = scale_of(mesh, s, use);
        for (const auto& chart : mesh.sheets[s].charts) spots.push_back({&chart, scale});
      }
  if (spots.empty()) return std::nullopt;  // load() says what is wrong
  const Atlas atlas = packed(spots, options);
  Writer writer(read_json(file), model);
  std::size_t spot = 0;
  for (const auto& [number, mesh] : meshes) writer.add(number, mesh, atlas, spot);
  result.glb = writer.finish();
  result.size = atlas.size;
  result.charts = spots.size();
  result.texels_per_metre = atlas.density;
  double filled = 0;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const auto& rectangle = atlas.rectangles[i];
    filled += static_cast<double>(rectangle.width - gutter) * (rectangle.height - gutter);
  }
  result.coverage = filled / atlas.size / atlas.size;
  return result;
}

Unwrapped unwrap(const std::filesystem::path& file, const UnwrapOptions& options) {
  return naming(file, [&] {
    Remarks remarks;  // load() tells them
    const auto model = read_model(file, remarks);
    Unwrapped result;
    if (auto made = unwrap(file, model, options))
      result = std::move(*made);
    else
      result.glb = PlainFile(read_json(file), model).finish();
    if (!model.scenes.empty())
      result.beside = sky_file_of(model.scenes[static_cast<std::size_t>(scene_of(model))].extras);
    return result;
  });
}

std::string summary_of(const Unwrapped& unwrapped) {
  return fmt::format("unwrapped into {} charts at {:.3g} texels a metre, {:.0f} % of {} x {} texels, as {}",
                     unwrapped.charts, unwrapped.texels_per_metre, 100 * unwrapped.coverage, unwrapped.size,
                     unwrapped.size, unwrapped.reason);
}

}  // namespace lichtveld::scene
