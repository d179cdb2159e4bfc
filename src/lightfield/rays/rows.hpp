// Who receives and sends light here: the texels, the backs of double-sided ones, and a place for each chart
// that is too small to hold a texel. Each has a number, its row in the table of links; up to 16 that follow
// each other lie together, and on a flat chart look along the same directions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::lightfield {

constexpr std::uint32_t no_row = ~0u;

class Rows {
 public:
  // `side`: texels a side of the block in which each takes another set.
  Rows(const scene::Scene& scene, const TexelRecords& records, std::uint32_t side);

  std::uint32_t count() const { return static_cast<std::uint32_t>(rows_.size()); }
  std::span<const TexelRecord> all() const { return rows_; }
  const TexelRecord& operator[](std::uint32_t row) const { return rows_[row]; }
  std::uint32_t set(std::uint32_t row) const { return sets_[row]; }  // of directions
  Range of_body(std::uint32_t body) const { return bodies_[body]; }
  std::uint32_t bodies() const { return static_cast<std::uint32_t>(bodies_.size()); }

  // Rows whose rays are followed together: up to 16 of one body each.
  struct Packet : Range {
    scene::Box box = {};  // around their places, bodies at rest [m]
    bool alike = true;    // they look along the same directions, and their faces are of one plane
  };
  std::span<const Packet> packets() const { return packets_; }
  Range packets_of_body(std::uint32_t body) const { return packets_of_body_[body]; }

  // The row of an atlas texel; no_row for what is none.
  std::uint32_t at(std::uint32_t atlas) const { return at_[atlas].row; }
  std::uint32_t size() const { return size_; }  // of the atlas

  // A texel of the atlas that has no row, but on which a chart without any texel lies, and the row whose light
  // it shows.
  struct Shown {
    std::uint32_t texel, row;
  };
  std::span<const Shown> shown_beside() const { return shown_beside_; }

  // each(row, dx, dy) for the texels at most `reach` beside one, itself too, where they are from there
  // [texels].
  template <typename Each>
  void for_each_around(std::uint32_t row, int reach, const Each& each) const {
    const std::uint32_t atlas = rows_[row].atlas;
    if (atlas == no_atlas_texel) return;
    const int size = static_cast<int>(size_), x = static_cast<int>(atlas) % size,
              y = static_cast<int>(atlas) / size;
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, size - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, size - 1); ++i)
        if (const auto other = at_[static_cast<std::size_t>(j * size + i)].row; other != no_row)
          each(other, i - x, j - y);
  }

  // Whether two texels lie on one surface, on the same side of all its creases.
  bool same_face(std::uint32_t a, std::uint32_t b) const;

  // Whose light is seen there.
  std::uint32_t seen(const scene::SurfacePoint& point, bool from_behind) const;

 private:
  struct Triangle {
    glm::vec2 origin, u, v;  // atlas coordinates [texels]
    glm::vec3 face;          // unit, as its NORMALs point
    bool turned;             // against the order of its corners
    std::uint32_t surface, face_key, fallback;
  };
  // What most look-ups need to know of an atlas texel.
  struct Cell {
    std::uint32_t row = no_row, face_key = 0;
  };

  std::uint32_t find(const Triangle& triangle, const glm::vec2& barycentric) const;
  void add_fallbacks(const scene::Scene& scene);
  void add_backs(const scene::Scene& scene);
  void show_fallbacks();
  bool has_row_around(int x, int y) const;
  void sort(std::size_t bodies, std::uint32_t side);
  void describe(Packet& packet) const;

  std::uint32_t size_;
  std::vector<TexelRecord> rows_;
  std::vector<Cell> at_;
  std::vector<std::uint32_t> back_;  // of each row: that of its back, or itself
  std::vector<std::uint32_t> sets_;
  std::vector<Packet> packets_;
  std::vector<Range> bodies_, packets_of_body_;
  std::vector<Triangle> triangles_;
  std::vector<Shown> shown_beside_;
};

}  // namespace lichtveld::lightfield
