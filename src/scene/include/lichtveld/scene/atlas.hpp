// The light map's atlas: which texels lie on a surface, and where.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::scene {

struct AtlasTexel {
  std::uint32_t index;  // row * size + column
  SurfacePoint at;      // its centre, which snapping may have put a hair outside of the triangle
};

// The valid texels of an atlas of size * size, by index: those whose centre lies on a chart, by the rules of
// graphics hardware. What is valid is decided here, for every method; geometry_texture draws the same ones.
std::vector<AtlasTexel> valid_texels(const Scene& scene, std::uint32_t size);

// Texels whose centres lie well within charts of two places; each shows what lies on it last. Copies of a
// triangle may share.
struct SharedTexels {
  struct Pair {
    std::string a, b;  // nodes, a <= b
    std::uint64_t texels;
  };
  std::vector<Pair> pairs;    // most texels first
  std::uint64_t texels = 0;   // of all pairs; no more than about a million are looked for
  std::vector<bool> at = {};  // by a texel's index
};

// Of an atlas of size * size. Throws SceneError for sizes outside 1..16384.
SharedTexels shared_texels(const Scene& scene, std::uint32_t size);

// Such as "\"floor\" and \"wall\" share 13": the five pairs that share most.
std::string text_of(const SharedTexels& shared);

// Checks the atlas at size * size texels: warns of charts that overlap, with their nodes and how many texels
// they share. Returns the number of valid texels. Throws SceneError where no texel is covered at all, and as
// shared_texels.
std::uint32_t check_atlas(const Scene& scene, std::uint32_t size);

}  // namespace lichtveld::scene
