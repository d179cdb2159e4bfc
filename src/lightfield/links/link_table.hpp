// The links: for each antipodal pair of directions and each valid texel the number of the texel that it sees,
// of the two directions along the one that it receives. Texels are numbered in blocks of the atlas, so that a
// tile of consecutive numbers lies together on a surface; lamps come first.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"
#include "passes/light_map.hpp"
#include "shared.h"

namespace lichtveld::lightfield {

// Where the tiles are: boxes around the texels of consecutive numbers, bodies at their places [m].
struct TileBoxes {
  struct Tile {
    glm::vec3 centre, half;  // half: of its extent
  };
  struct Group {
    Tile around;
    std::uint32_t first, end;  // of its tiles
  };
  std::vector<Tile> tiles;
  std::vector<Group> groups;  // of tiles that lie together
};

struct LinkTable {
  // `map` holds the geometry texture with every body at rest. Throws std::runtime_error if the links would take
  // more than the device has.
  LinkTable(const gpu::Device& device, const scene::Scene& scene, const LightMap& map, std::uint32_t pairs);

  // Links of consecutive pairs, an even number, as many as one buffer may hold; word_at (links.glsl) says
  // where.
  struct Chunk {
    std::uint32_t first_pair, pairs;
    gpu::Buffer links;
  };

  // Of links that see nothing yet.
  Chunk make_chunk(const gpu::Device& device, const std::string& name, std::uint32_t first_pair,
                   std::uint32_t pairs) const;

  std::uint32_t texels = 0;       // valid ones
  std::uint32_t pairs = 0;        // of directions
  std::uint32_t bits = 16;        // of a link
  std::uint32_t lamps_alike = 0;  // of the lamps, from the first on, that send the same
  float brightest = 0;            // of the lamps, any channel [W m^-2 sr^-1]
  std::vector<glm::vec3> lamps;   // Le of the texels that come first [W m^-2 sr^-1]
  std::vector<Chunk> chunks;
  gpu::Buffer texel_of;  // uint: the atlas texel of each number
  gpu::Image number;     // uint: the number of each atlas texel's source; `texels` outside charts and gutters

  std::uint32_t lamp_count() const { return static_cast<std::uint32_t>(lamps.size()); }
  std::uint32_t groups() const { return (texels + shaders::TILE - 1) / shaders::TILE; }  // workgroups over all
  std::uint32_t tile = 64;  // texels that are routed together: a vector of the device's
  TileBoxes boxes(const std::vector<glm::vec3>& offsets) const;

 private:
  std::uint64_t bytes_of(std::uint32_t pairs) const;  // their links

  struct Texel {
    glm::vec3 at_rest;  // [m]
    std::uint32_t body;
  };
  std::vector<Texel> places_;
};

}  // namespace lichtveld::lightfield
