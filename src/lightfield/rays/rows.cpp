#include "rays/rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "core/parallel.hpp"
#include "core/texel_albedo.hpp"

namespace lichtveld::lightfield {

namespace {

// Atlas texels a side of a tile whose rows stand together, set by set: with blocks of 4 x 4, up to 256 have the
// same.
constexpr std::uint32_t tile = 64;
constexpr std::uint32_t packet = 16;
constexpr std::uint32_t packets_of_a_task = 64;

// Places are moved this far towards the middle of their triangle: rays that start on an edge shared with a wall
// could, by rounding, start behind that wall [radii of the scene].
constexpr float inset = 2e-6f;

// A texel stands for what is seen of its surface, around the corner of a box too unless it looks another way.
constexpr float alike_cosine = 0.7f;
// Texels whose faces or normals are turned by more are on other sides of a crease.
constexpr float crease_cosine = 0.95f;
// Faces of one plane's triangles differ by rounding alone.
constexpr float same_face_apart = 1e-6f;
// A texel's plane ends this share of the way to its neighbour above or below it.
constexpr float plane_share = 0.1f;
constexpr int reach = 2;  // texels beyond its chart's rim that a point may lie

// Places a texel's side along a triangle's edges at which it is looked for the texels that it touches.
constexpr float touches_a_texel = 2;

// Which way it looks, roughly.
std::uint32_t facing(const glm::vec3& face) {
  const glm::vec3 size = glm::abs(face);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return static_cast<std::uint32_t>(2 * axis + (face[axis] < 0));
}

// Places of the same key are on one surface and look roughly the same way.
std::uint32_t face_key(std::uint32_t surface, const glm::vec3& face) {
  return surface * 6 + facing(face);
}

// The bits of both, in turn: what is near in this order is near both ways (Morton 1966).
std::uint32_t interleaved(std::uint32_t x, std::uint32_t y) {
  std::uint32_t code = 0;
  for (std::uint32_t bit = 0; bit < 16; ++bit)
    code |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
  return code;
}

}  // namespace

Rows::Rows(const scene::Scene& scene, const TexelRecords& records, std::uint32_t side)
    : size_(records.size()), rows_(records.all()) {
  const auto surfaces = surface_of_triangles(scene);
  triangles_.resize(surfaces.size());
  for (std::uint32_t triangle = 0; triangle < triangles_.size(); ++triangle) {
    const auto corner = [&](std::size_t k) -> const scene::Vertex& {
      return scene.vertices[scene.indices[std::size_t{3} * triangle + k]];
    };
    const scene::Vertex &a = corner(0), &b = corner(1), &c = corner(2);
    const auto size = static_cast<float>(size_);
    const auto [face, turned] = scene::facing_of(scene, triangle);
    triangles_[triangle] = {.origin = size * a.atlas,
                            .u = size * (b.atlas - a.atlas),
                            .v = size * (c.atlas - a.atlas),
                            .face = face,
                            .turned = turned,
                            .surface = surfaces[triangle],
                            .face_key = face_key(surfaces[triangle], face),
                            .fallback = no_row};
  }
  const float shift = inset * scene::bounding_sphere(scene).radius;
  for (TexelRecord& row : rows_) {
    glm::vec3 middle(0);
    for (std::size_t k = 0; k < 3; ++k)
      middle += scene.vertices[scene.indices[std::size_t{3} * row.triangle + k]].position / 3.0f;
    const glm::vec3 way = middle - row.position;
    row.position += way * (shift / std::max(glm::length(way), shift));
  }
  add_fallbacks(scene);
  add_backs(scene);
  sort(scene.bodies.size(), side);
  show_fallbacks();
}

// A place in the middle of each chart that no texel stands for; triangles whose middles lie in the same texel
// share it, and it reflects what they do together.
void Rows::add_fallbacks(const scene::Scene& scene) {
  const auto texels = static_cast<std::uint32_t>(rows_.size());
  at_.assign(std::size_t{size_} * size_, Cell{});
  for (std::uint32_t row = 0; row < rows_.size(); ++row)
    at_[rows_[row].atlas] = {row, face_key(rows_[row].surface, rows_[row].face)};
  std::map<std::tuple<std::uint32_t, std::uint32_t, int, int>, std::uint32_t> found;
  std::vector<glm::vec4> reflected;  // of each of them: albedo times area, and area
  for (std::uint32_t index = 0; index < triangles_.size(); ++index) {
    Triangle& triangle = triangles_[index];
    const glm::vec2 middle(1.0f / 3);
    if (triangle.face == glm::vec3(0) || find(triangle, middle) != no_row) continue;
    const glm::ivec2 cell(glm::floor(triangle.origin + (triangle.u + triangle.v) / 3.0f));
    const auto [place, is_new] =
        found.try_emplace({triangle.surface, facing(triangle.face), cell.x, cell.y}, rows_.size());
    const auto corner = [&](std::size_t k) {
      return scene.vertices[scene.indices[std::size_t{3} * index + k]].position;
    };
    const float area = glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    if (is_new) {
      auto record = record_at(scene, size_, {index, middle}, triangle.surface, no_atlas_texel);
      record.side = std::sqrt(area);
      rows_.push_back(record);
      reflected.emplace_back(0);
    }
    triangle.fallback = place->second;
    reflected[place->second - texels] += area * glm::vec4(mean_albedo(scene, triangle.surface, index), 1);
  }
  for (std::size_t i = 0; i < reflected.size(); ++i)
    rows_[texels + i].albedo = glm::vec3(reflected[i]) / reflected[i].a;
}

void Rows::add_backs(const scene::Scene& scene) {
  const auto fronts = static_cast<std::uint32_t>(rows_.size());
  back_.resize(fronts);
  std::iota(back_.begin(), back_.end(), 0u);
  for (std::uint32_t row = 0; row < fronts; ++row) {
    if (!scene.materials[scene.surfaces[rows_[row].surface].material].double_sided) continue;
    back_[row] = static_cast<std::uint32_t>(rows_.size());
    TexelRecord back = rows_[row];
    back.normal = -back.normal;
    back.face = -back.face;
    back.atlas = no_atlas_texel;
    rows_.push_back(back);
    back_.push_back(back_[row]);
  }
}

// Until now rows stood in the order in which they were found.
void Rows::sort(std::size_t bodies, std::uint32_t side) {
  // What keeps packets apart comes first; the row, which follows all else, last.
  using Key = std::array<std::uint32_t, 8>;
  constexpr std::size_t kept_apart = 6;  // of them
  const std::uint32_t tiles = (size_ + tile - 1) / tile;
  std::vector<std::uint32_t> texel(rows_.size()), front(rows_.size());
  std::iota(front.begin(), front.end(), 0u);
  for (std::uint32_t row = 0; row < rows_.size(); ++row) {
    if (back_[row] != row) front[back_[row]] = row;
  }
  std::vector<Key> keys;
  for (std::uint32_t row = 0; row < rows_.size(); ++row) {
    const TexelRecord& record = rows_[row];
    // A back stands where its texel does.
    const std::uint32_t atlas = record.atlas != no_atlas_texel ? record.atlas : rows_[front[row]].atlas;
    const bool has_texel = atlas != no_atlas_texel;
    const std::uint32_t x = has_texel ? atlas % size_ : 0, y = has_texel ? atlas / size_ : 0;
    texel[row] = has_texel ? (y % side) * side + x % side : row % (side * side);
    keys.push_back({record.body, has_texel ? y / tile * tiles + x / tile : tiles * tiles, record.surface,
                    facing(record.face), record.atlas != no_atlas_texel ? 0u : 1u, texel[row],
                    interleaved(x / side, y / side), row});
  }
  std::ranges::sort(keys,
                    [](const Key& a, const Key& b) { return std::ranges::lexicographical_compare(a, b); });

  std::vector<std::uint32_t> moved_to(rows_.size());
  std::vector<TexelRecord> sorted;
  bodies_.assign(bodies, Range{0, 0});
  packets_of_body_ = bodies_;
  for (const Key& key : keys) {
    const auto row = static_cast<std::uint32_t>(sorted.size());
    const bool alike = row > 0 && std::equal(key.begin(), key.begin() + kept_apart, keys[row - 1].begin());
    const std::uint32_t body = key[0];
    if (row == 0 || body != keys[row - 1][0]) {
      bodies_[body] = {row, row};
      const auto next = static_cast<std::uint32_t>(packets_.size());
      packets_of_body_[body] = {next, next};
    }
    if (!alike || packets_.back().size() == packet) packets_.push_back({{row, row}});
    packets_.back().end = bodies_[body].end = row + 1;
    packets_of_body_[body].end = static_cast<std::uint32_t>(packets_.size());
    moved_to[key[7]] = row;
    sorted.push_back(rows_[key[7]]);
    sets_.push_back(texel[key[7]]);
  }
  std::vector<std::uint32_t> back(rows_.size());
  for (std::uint32_t row = 0; row < rows_.size(); ++row) back[moved_to[row]] = moved_to[back_[row]];
  back_ = std::move(back);
  rows_ = std::move(sorted);
  for_each_index(0, static_cast<std::uint32_t>(packets_.size()), packets_of_a_task,
                 [&](std::uint32_t packet) { describe(packets_[packet]); });
  for (auto& cell : at_)
    if (cell.row != no_row) cell.row = moved_to[cell.row];
  for (auto& triangle : triangles_)
    if (triangle.fallback != no_row) triangle.fallback = moved_to[triangle.fallback];
}

// Where such charts touch a texel that is no chart's; then its neighbours, which filtering reads with it, where
// they are of no chart either.
void Rows::show_fallbacks() {
  const int size = static_cast<int>(size_);
  std::vector<std::uint32_t> shown(at_.size(), no_row);
  const auto show = [&](int x, int y, std::uint32_t row) {
    if (x < 0 || y < 0 || x >= size || y >= size) return;
    const auto texel = static_cast<std::uint32_t>(y * size + x);
    if (at_[texel].row != no_row || shown[texel] != no_row) return;
    shown[texel] = row;
    shown_beside_.push_back({texel, row});
  };
  for (const auto& [origin, u, v, face, turned, surface, face_key, fallback] : triangles_) {
    if (fallback == no_row) continue;
    const float longest = std::max({glm::length(u), glm::length(v), glm::length(v - u)});
    const float steps =
        std::clamp(std::ceil(longest * touches_a_texel), 1.0f, touches_a_texel * static_cast<float>(size_));
    // Its inside is narrower than a texel.
    for (const auto& [from, along] : {std::pair{origin, u}, {origin, v}, {origin + u, v - u}})
      for (float step = 0.5f; step < steps; ++step) {
        const glm::ivec2 cell(glm::floor(from + step / steps * along));
        show(cell.x, cell.y, fallback);
      }
  }
  for (std::size_t i = 0, touched = shown_beside_.size(); i < touched; ++i) {
    const auto [texel, row] = shown_beside_[i];
    const int x = static_cast<int>(texel) % size, y = static_cast<int>(texel) / size;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (!has_row_around(x + dx, y + dy)) show(x + dx, y + dy, row);
  }
}

// Whether filtering at a chart's rim may read a texel.
bool Rows::has_row_around(int x, int y) const {
  const int size = static_cast<int>(size_);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size - 1); ++i)
      if (at_[static_cast<std::size_t>(j * size + i)].row != no_row) return true;
  return false;
}

void Rows::describe(Packet& packet) const {
  packet.box = {rows_[packet.first].position, rows_[packet.first].position};
  for (std::uint32_t row = packet.first; row < packet.end; ++row) {
    packet.box.min = glm::min(packet.box.min, rows_[row].position);
    packet.box.max = glm::max(packet.box.max, rows_[row].position);
    packet.alike = packet.alike && rows_[row].normal == rows_[packet.first].normal &&
                   glm::distance(rows_[row].face, rows_[packet.first].face) < same_face_apart &&
                   sets_[row] == sets_[packet.first];
  }
}

std::uint32_t Rows::find(const Triangle& triangle, const glm::vec2& barycentric) const {
  const glm::vec2 place = triangle.origin + barycentric.x * triangle.u + barycentric.y * triangle.v;
  const int size = static_cast<int>(size_);
  const int x = std::clamp(static_cast<int>(std::floor(place.x)), 0, size - 1),
            y = std::clamp(static_cast<int>(std::floor(place.y)), 0, size - 1);
  const auto fits = [&](std::uint32_t row) {
    return row != no_row && rows_[row].surface == triangle.surface &&
           glm::dot(rows_[row].face, triangle.face) > alike_cosine;
  };
  const auto& here = at_[static_cast<std::size_t>(y * size + x)];
  if (here.row != no_row && (here.face_key == triangle.face_key || fits(here.row))) return here.row;
  const auto texel = [&](int i, int j) { return at_[static_cast<std::size_t>(j * size + i)].row; };
  std::uint32_t found = triangle.fallback;
  float best = std::numeric_limits<float>::max();
  for (int j = std::max(y - reach, 0); j <= std::min(y + reach, size - 1); ++j)
    for (int i = std::max(x - reach, 0); i <= std::min(x + reach, size - 1); ++i) {
      const glm::vec2 apart = glm::vec2(i, j) + 0.5f - place;
      if (const float distance = glm::dot(apart, apart); distance < best && fits(texel(i, j))) {
        best = distance;
        found = texel(i, j);
      }
    }
  return found;
}

bool Rows::same_face(std::uint32_t a, std::uint32_t b) const {
  const TexelRecord &one = rows_[a], &other = rows_[b];
  const glm::vec3 apart = other.position - one.position;
  return one.body == other.body && one.surface == other.surface &&
         glm::dot(one.face, other.face) >= crease_cosine &&
         glm::dot(one.normal, other.normal) >= crease_cosine &&
         std::abs(glm::dot(apart, one.face)) <= plane_share * std::max(glm::length(apart), one.side);
}

std::uint32_t Rows::seen(const scene::SurfacePoint& point, bool from_behind) const {
  const Triangle& triangle = triangles_[point.triangle];
  const auto row = find(triangle, point.barycentric);
  // One-sided surfaces have no back: a NORMAL that looks the other way changes only where they receive.
  return row != no_row && from_behind != triangle.turned ? back_[row] : row;
}

}  // namespace lichtveld::lightfield
