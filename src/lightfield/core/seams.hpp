// What players see across the seams of an atlas: each chart is filtered by itself, so that two which meet
// differ along their common edge by what a texel is off, and the eye finds it. Here texels by a seam are
// shifted by as little as makes both sides agree, in the sense of least squares (Iwanicki, "Lighting Technology
// of The Last of Us", 2013). Of what is shown alone: E stays what it is.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

class Seams {
 public:
  Seams(const scene::Scene& scene, const TexelRecords& records);
  ~Seams();

  // Those by a seam, of the atlas, gutters too.
  const std::vector<std::uint32_t>& texels() const { return texels_; }

  // What is added to the radiance that each of texels() shows [W m^-2 sr^-1]. `irradiance`: of the atlas
  // [W m^-2]. Where something lies on a texel by a seam, and it has no light, the seam stays.
  std::vector<glm::vec3> offsets(std::span<const glm::vec4> irradiance) const;

 private:
  struct Shows {
    std::uint32_t texel;  // of the atlas: whose light it is
    glm::vec3 reflected;  // albedo / pi there [sr^-1]
  };
  struct Tap {
    std::uint32_t texel;  // of texels()
    float weight;         // above 0 on one side of the seam, below on the other
  };
  struct Factored;

  std::vector<std::uint32_t> texels_;
  std::vector<Shows> shows_;  // of each of them
  std::vector<Tap> taps_;
  std::vector<std::uint32_t>
      ends_;  // of each place on a seam where both sides shall agree: its last tap's, + 1
  std::unique_ptr<const Factored> factored_;
};

}  // namespace lichtveld::lightfield
