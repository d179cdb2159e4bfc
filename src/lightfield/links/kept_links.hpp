// What --method links knows of a scene but its light: the geometry texture, which texel each texel sees along
// each pair of directions, and the direct light that follows from it. Goes where the bodies go: outside of what
// they have swept every link stays.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "links/route_links.hpp"
#include "passes/geometry_texture.hpp"

namespace lichtveld::lightfield {

class KeptLinks {
 public:
  // Throws like Links. The device and the scene must outlive it.
  KeptLinks(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);

  // Brings the links to where the bodies are, and what it counts into `solution`. Should it throw, all of them
  // have to be linked again (moves.all).
  void link(const scene::Offsets& to, const scene::Scales& scales, const Moves& moves, Solution& solution);
  // Sums direct light up afresh, where links have changed since: what they have kept, by construction.
  void sum_direct();
  // As LightField::check_links, once all is linked.
  LinkCheck check(std::uint32_t pairs);
  // Writes map().shown: what lies open to the light where the bodies are.
  void find_shown(gpu::Frame& frame);

  // Groups of texels (of shaders::GROUP) beside what the last link() found moved.
  const std::vector<std::uint32_t>& beside() const { return beside_; }
  const TexelRecords& records() const { return records_; }
  const LightMap& map() const { return map_; }
  const LinkTable& table() const { return table_; }
  const DirectLight& direct() const { return direct_; }
  const gpu::Buffer& directions() const { return directions_; }  // vec4 a pair: xyz; w: solid angle [sr]

 private:
  // Everything that depends on how many layers a pixel's list holds.
  struct Layered {
    Layered(const gpu::Device& device, const Settings& settings, const LinkTable& table, std::uint32_t capacity)
        : store(device, settings, capacity), route(device, store, table) {}
    LinkStore store;
    RouteLinks route;
    bool received = false;  // RouteLinks::read_receivers, since the last move
  };

  void link(const scene::Offsets& to, const Moves& moves, Solution& solution);
  Patch whole_patch(std::uint32_t pair) const;
  std::vector<Patch> whole_patches() const;
  std::vector<Patch> changed_patches(const Moves::Move& move) const;
  std::vector<scene::Box> moved_boxes(const Moves& moves) const;
  void route(const std::vector<Patch>& patches, const TileBoxes& tiles, Solution& solution);
  Layered& layered();
  LinkCheck check_two();

  const gpu::Device& device_;
  const Settings settings_;
  const TexelRecords records_;
  const DirectionSet set_;
  Geometry geometry_;
  LightMap map_;
  GeometryTexture geometry_texture_;
  gpu::Buffer counters_;    // host-visible
  gpu::Buffer directions_;  // of the pairs
  LinkTable table_;
  DirectLight direct_;
  std::uint32_t capacity_;  // layers of a pixel's list
  std::unique_ptr<Layered> layered_;
  std::optional<LinkTable::Chunk> again_;  // links of two pairs, to compare
  // What has been done since the last move.
  struct Done {
    scene::Offsets linked_at;    // where the bodies are
    bool direct_summed = false;  // afresh
    std::uint32_t pairs_checked = 0;
  };
  Done done_;
  std::vector<std::uint32_t> beside_;
  // Groups of texels that may be covered otherwise than map_.cover says.
  std::set<std::uint32_t> cover_unknown_;
};

}  // namespace lichtveld::lightfield
