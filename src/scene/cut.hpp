// Surfaces of which textures say where they are, and where they shine.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"
#include "textures.hpp"

namespace lichtveld::scene {

// What a material has besides Material, for which its triangles are cut into even ones.
struct Uneven {
  enum class Alpha { opaque, mask, blend };
  Alpha alpha = Alpha::opaque;
  float cutoff = 0.5f;     // of a mask
  float alpha_factor = 1;  // times the alpha of the base colour's texture and of COLOR_0
  float transmission = 0;  // the share of the light that its base colour lets through, 0..1
  int emission = -1;       // the texture that emission is multiplied with, of Scene::textures; or -1
  std::array<Wrap, 2> wrap = {};
  TextureCoordinates emission_at = {};

  bool any() const { return alpha != Alpha::opaque || transmission > 0 || emission >= 0; }
};

// Triangles of one material.
struct Cut {
  Material material;
  std::vector<std::uint32_t> indices;  // of scene.vertices
};

// How many times triangles are cut in four where so many of a scene may have to be: 200,000 pieces in all.
int cuts_for(std::size_t triangles);

// The triangles of a material, cut until each has one emission and is there or is not, or so many times. The
// last pieces are there as often as their light needs: of a pane that lets half of it through every second one
// is, so that any method has the light right on the whole, if not its colour. `emission_at` is a coordinate for
// each of scene.vertices from `first` on. New vertices are appended.
std::vector<Cut> cut(const Material& material, const Uneven& uneven, const std::vector<std::uint32_t>& indices,
                     const std::vector<glm::vec2>& emission_at, std::uint32_t first, int times,
                     const std::vector<Texture>& textures, std::vector<Vertex>& vertices);

}  // namespace lichtveld::scene
