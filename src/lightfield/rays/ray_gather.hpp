// A bounce: each row sums up what the rows that it sees send.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/lamp_light.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "rays/ray_links.hpp"
#include "rays/rows.hpp"

namespace lichtveld::lightfield {

class RayGather {
 public:
  // All of these must outlive it.
  RayGather(const Rows& rows, const RayLinks& links, Direct direct);

  // Where a row is buried, others still see its open part, if it has one: it sends what its nearest
  // open neighbour does.
  void find_sources();

  // No light has been reflected yet.
  void start();
  struct Change {
    double most = 0, mean = 0;  // of E's channels: by how much any has changed; of all texels [W m^-2]
  };
  // What rows send changes with the light that comes straight from lamps: E of each row [W m^-2], none with
  // Direct::psf. Where nothing has been reflected yet, that is what has changed.
  Change set_lamps(std::span<const glm::vec3> irradiance);
  Change bounce();

  Direct direct() const { return direct_; }
  // Of each row, what has been gathered [W m^-2], and by how much the first half of the rays says more than
  // both.
  std::span<const glm::vec4> gathered() const { return gathered_; }
  std::span<const glm::vec4> half_difference() const { return half_difference_; }

 private:
  void send();
  glm::vec4 sent(std::uint32_t row, std::uint32_t source) const;
  std::uint32_t open_neighbour(std::uint32_t row) const;

  const Rows& rows_;
  const RayLinks& links_;
  const Direct direct_;
  // L of each row as others see it, and of nothing and outside: 0; and as those that are buried with it do.
  std::vector<glm::vec4> radiance_, own_radiance_;
  std::vector<glm::vec4> gathered_, half_difference_;
  std::vector<glm::vec3> lamps_;
  std::vector<std::uint32_t> source_;  // of each row: whose E it sends
};

}  // namespace lichtveld::lightfield
