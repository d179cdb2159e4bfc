// One glTF primitive to triangles in world space.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <unordered_map>

#include "accessor.hpp"
#include "parts.hpp"
#include "triangle.hpp"
#include "vertices.hpp"

namespace lichtveld::scene {
namespace {

std::vector<Triangle> triangles_of(const tinygltf::Primitive& primitive, const std::optional<Accessor>& indices,
                                   std::size_t vertices, std::size_t max_triangles, const std::string& what) {
  const std::size_t count = indices ? indices->count() : vertices;
  const bool is_list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  if (is_list && count % 3 != 0) {
    throw SceneError(what + ": " + std::to_string(count) + " corners are no whole number of triangles");
  }
  const std::size_t triangles = is_list ? count / 3 : count < 3 ? 0 : count - 2;
  if (triangles > max_triangles)
    throw SceneError(what + ": the scene has more than 4 million triangles; simplify it");
  const auto corner = [&](std::size_t i) {
    const std::uint32_t index = indices ? indices->index(i) : static_cast<std::uint32_t>(i);
    if (index >= vertices) {
      throw SceneError(what + ": index " + std::to_string(index) + " of " + std::to_string(vertices) +
                       " vertices");
    }
    return index;
  };
  std::vector<Triangle> result;
  result.reserve(triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    switch (primitive.mode) {
      case TINYGLTF_MODE_TRIANGLES:
        result.push_back({corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)});
        break;
      case TINYGLTF_MODE_TRIANGLE_STRIP:  // every second one runs the other way round
        result.push_back({corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)});
        break;
      default:
        result.push_back({corner(i + 1), corner(i + 2), corner(0)});  // fan
    }
  }
  return result;
}

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

// A required attribute with as many elements as there are positions.
Accessor coordinates(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                     const std::string& name, std::size_t vertices, const std::string& what,
                     const std::string& advice) {
  const int index = attribute(primitive, name);
  if (!primitive.attributes.contains(name)) throw SceneError(what + " has no " + name + ": " + advice);
  Accessor result(model, index, what + ", " + name);
  result.require_vectors(2);
  if (result.count() < vertices) throw SceneError(what + ": " + name + " has fewer elements than POSITION");
  return result;
}

glm::vec3 world_position(const Vertices& vertices, std::uint32_t i, const glm::dmat4& world,
                         const std::string& what) {
  const glm::dvec3 p = world * glm::dvec4(vertices.position(i), 1);
  check_place(p, i, what);
  return p;
}

glm::vec2 atlas_coordinate(const Accessor& atlas, std::uint32_t i, const std::string& what,
                           Oddities& oddities) {
  const glm::vec2 uv = atlas.vec2(i), inside = glm::clamp(uv, 0.0f, 1.0f);
  if (!(glm::distance(uv, inside) <= atlas_rounding)) {
    throw SceneError(what + ": TEXCOORD_1 of vertex " + std::to_string(i) + " is (" + std::to_string(uv.x) +
                     ", " + std::to_string(uv.y) +
                     "), outside 0..1: pack the light-map charts into the unit square");
  }
  constexpr float rounding = 1e-5f;
  if (glm::distance(uv, inside) > rounding) ++oddities.outside_atlas;
  return inside;
}

// What the texture is read by. Where the primitive lacks that set, viewers take (0, 0).
std::optional<Accessor> colours_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive, int set,
                                   std::size_t vertices, const std::string& what, Oddities& oddities) {
  if (set < 0) return std::nullopt;
  const std::string name = "TEXCOORD_" + std::to_string(set);
  if (!primitive.attributes.contains(name)) {
    oddities.remarks.add("has no " + name + " for its texture, whose corner colours it all", what,
                         "export it with the texture's coordinates, or take the texture off");
    return std::nullopt;
  }
  return coordinates(model, primitive, name, vertices, what, "");
}

glm::vec2 texture_place(const TextureCoordinates& of, const std::optional<Accessor>& coordinates,
                        std::uint32_t i, const std::string& what) {
  const glm::vec2 at = of.transform * glm::dvec3(coordinates ? coordinates->vec2(i) : glm::vec2(0), 1);
  constexpr float farthest = 1e30f;  // sums of some are finite, which is what lies between them
  if (!(std::abs(at.x) <= farthest && std::abs(at.y) <= farthest))
    throw SceneError(what + ": the texture coordinate of vertex " + std::to_string(i) +
                     " is not finite or beyond 1e30");
  return at;
}

// COLOR_0.
std::optional<Accessor> tints_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                 std::size_t vertices, const std::string& what) {
  if (!primitive.attributes.contains("COLOR_0")) return std::nullopt;
  Accessor tints(model, attribute(primitive, "COLOR_0"), what + ", COLOR_0");
  tints.require_vectors(tints.components() == 3 ? 3 : 4);
  if (tints.count() < vertices) throw SceneError(what + ": COLOR_0 has fewer elements than POSITION");
  return tints;
}

// Vertex::tint, which takes whatever 8 or 16 bits hold as it is.
glm::u16vec4 tint_of(const std::optional<Accessor>& tints, std::uint32_t i, const std::string& what) {
  if (!tints) return glm::u16vec4(65535);
  const glm::vec4 tint = tints->components() == 3 ? glm::vec4(tints->vec3(i), 1) : tints->vec4(i);
  for (int c = 0; c < 4; ++c)
    if (!std::isfinite(tint[c]))
      throw SceneError(what + ": COLOR_0 of vertex " + std::to_string(i) + " is not finite");
  return glm::packUnorm<std::uint16_t>(glm::clamp(tint, 0.0f, 1.0f));
}

// Whether the primitive has normals that can be used; faces' own stand in for them where not.
bool has_good_normals(const Vertices& vertices, const std::vector<Triangle>& triangles, Oddities& oddities) {
  if (!vertices.has_normals()) return false;
  for (const Triangle& triangle : triangles) {
    for (std::uint32_t i : triangle) {
      const double length = glm::length(vertices.normal(i));
      if (!(length > 1e-6 && length < 1e6)) {
        ++oddities.bad_normals;
        return false;
      }
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<Triangle>> triangles_of(const tinygltf::Model& model,
                                                  const tinygltf::Primitive& primitive,
                                                  std::size_t& triangles_left, const std::string& what) {
  if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    throw SceneError(what + ": unknown mode " + std::to_string(primitive.mode));
  }
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return std::nullopt;
  if (!primitive.attributes.contains("POSITION")) throw SceneError(what + " has no POSITION");
  const std::size_t vertices = Accessor(model, attribute(primitive, "POSITION"), what + ", POSITION").count();
  std::optional<Accessor> indices;
  if (primitive.indices != -1) {
    indices.emplace(model, primitive.indices, what + ", indices");
    indices->require_indices();
  }
  auto triangles = triangles_of(primitive, indices, vertices, triangles_left, what);
  triangles_left -= triangles.size();
  return triangles;
}

std::vector<std::uint32_t> add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const Placement& placement, const TextureCoordinates& colour,
                                         const Uneven& uneven, std::vector<glm::vec2>& emission_at,
                                         std::size_t& triangles_left, Scene& scene, Oddities& oddities) {
  const std::string what = "node \"" + placement.node + "\", primitive " + std::to_string(placement.primitive);
  const auto triangles = triangles_of(model, primitive, triangles_left, what);
  if (!triangles) {
    ++oddities.no_triangles;
    return {};
  }
  const Vertices shape(model, primitive, placement, what);
  const std::size_t vertices = shape.count();
  const Accessor atlas =
      coordinates(model, primitive, "TEXCOORD_1", vertices, what,
                  "unwrap the scene into a second UV map without overlaps (the light map's)");
  const std::optional<Accessor> colours = colours_of(model, primitive, colour.set, vertices, what, oddities);
  const std::optional<Accessor> emissions =
      colours_of(model, primitive, uneven.emission_at.set, vertices, what, oddities);
  const std::optional<Accessor> tints = tints_of(model, primitive, vertices, what);
  const bool smooth = has_good_normals(shape, *triangles, oddities);

  std::vector<std::uint32_t> result;
  std::unordered_map<std::uint32_t, std::uint32_t> shared;  // element -> vertex, where the file has normals
  for (Triangle triangle : *triangles) {
    if (shape.transform(triangle[0]).mirrored) std::swap(triangle[1], triangle[2]);
    Corners p;
    std::array<glm::vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = world_position(shape, triangle[k], shape.transform(triangle[k]).world, what);
      uv[k] = atlas_coordinate(atlas, triangle[k], what, oddities);
    }
    const glm::dvec3 cross = cross_of(p);
    if (!has_area(p)) {
      ++oddities.zero_area;
      continue;
    }
    const glm::dvec2 s = uv[1] - uv[0], t = uv[2] - uv[0];
    if (s.x * t.y == s.y * t.x) ++oddities.zero_chart;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = triangle[k];
      const auto next = static_cast<std::uint32_t>(scene.vertices.size());
      if (smooth) {
        const auto [known, is_new] = shared.try_emplace(i, next);
        result.push_back(known->second);
        if (!is_new) continue;
      } else {
        result.push_back(next);
      }
      const glm::dvec3 direction = smooth ? shape.transform(i).cofactors * shape.normal(i) : cross;
      const double length = glm::length(direction);
      const glm::vec2 at = texture_place(colour, colours, i, what);
      if (uneven.emission >= 0) emission_at.push_back(texture_place(uneven.emission_at, emissions, i, what));
      // A flattening node can leave a normal without length; the face's own is right then.
      scene.vertices.push_back({p[k], glm::normalize(length > 0 ? direction : cross), uv[k], at, placement.body,
                                tint_of(tints, i, what)});
    }
  }
  return result;
}

}  // namespace lichtveld::scene
