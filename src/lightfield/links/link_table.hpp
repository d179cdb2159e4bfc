// The links: for each antipodal pair of directions and each valid texel the number of the texel that it sees,
// of the two directions along the one that it receives. Numbers are those of TexelRecords.
#pragma once

#include <string>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/gpu/resources.hpp"
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
  // The records must outlive it. Throws std::runtime_error if the links would take more than the device has, or
  // than `most_bytes`, if that is above 0.
  LinkTable(const gpu::Device& device, const TexelRecords& records, std::uint32_t pairs,
            std::uint64_t most_bytes);

  // Links of consecutive pairs, an even number, as many as one buffer may hold; word_at (links.glsl) says
  // where.
  struct Chunk {
    std::uint32_t first_pair, pairs;
    gpu::Buffer links;
  };

  // Of links that see nothing yet.
  Chunk make_chunk(const gpu::Device& device, const std::string& name, std::uint32_t first_pair,
                   std::uint32_t pairs) const;

  const TexelRecords& records;
  std::uint32_t texels;     // valid ones
  std::uint32_t pairs;      // of directions
  std::uint32_t bits = 16;  // of a link
  std::vector<Chunk> chunks;
  gpu::Buffer texel_of;  // uint: the atlas texel of each number
  gpu::Image number;     // uint: the number of each atlas texel's source; `texels` outside charts and gutters

  std::uint32_t groups() const {
    return (texels + shaders::GROUP - 1) / shaders::GROUP;
  }                         // workgroups over all
  std::uint32_t tile = 64;  // texels that are routed together: a vector of the device's
  TileBoxes boxes(const scene::Offsets& offsets) const;

 private:
  std::uint64_t bytes_of(std::uint32_t pairs) const;  // their links
};

}  // namespace lichtveld::lightfield
