// A light map's atlas for scenes that have none of their own, or one that cannot be used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

struct Unwrapped {
  std::vector<std::uint8_t> glb;  // the scene as one .glb with TEXCOORD_1, everything else as it was
  std::string beside;             // the file that the scene names and that is not in it, its sky; or empty
  std::string reason;             // why its own TEXCOORD_1 is not used; empty where it is
  std::uint32_t size = 0;         // texels a side at which charts lie on whole texels, two apart
  std::size_t charts = 0;
  double texels_per_metre = 0;
  double coverage = 0;  // the share of the atlas that charts fill, 0..1
};

// The scene's own TEXCOORD_1 stays where every node has one within 0..1 that has an area, and no more than a
// hair of it overlaps. Otherwise charts of one's own are kept as far as they do not fold, and packed anew, each
// node's in a place of its own and as large as its surface; what has none is laid flat. A double-sided surface
// that is not the outside of a closed body becomes two, back to back. The same file gives the same bytes.
// Throws SceneError as load() does (for a scene without triangles, too), or where no atlas of 4096 texels a side
// can hold the charts.
Unwrapped unwrap(const std::filesystem::path& file, const UnwrapOptions& options = {});

// What was done, as a sentence goes on: "unwrapped into 12 charts ...".
std::string summary_of(const Unwrapped& unwrapped);

}  // namespace lichtveld::scene
