// Which texels are lamps, in which order, and what each sends. (Which triangles are:
// scene::emitting_triangles.)
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lichtveld::lightfield {

class Lamps {
 public:
  // What each lamp sends, in their order, and the brightest of all places, any channel [W m^-2 sr^-1].
  Lamps(std::vector<glm::vec3> emission, float brightest);

  // What emits less than this share of the brightest is no lamp: the whole numbers that direct light is summed
  // in would not tell its shades. A bounce gathers its light with what surfaces reflect.
  static constexpr float dimmest = 1e-4f;
  static bool is_lamp(const glm::vec3& emission, float brightest);
  static float strength(const glm::vec3& emission);  // of its strongest channel

  // The places that are lamps: numbers 0 .. count() - 1, with what each sends.
  std::uint32_t count() const { return static_cast<std::uint32_t>(emission_.size()); }
  const std::vector<glm::vec3>& emission() const { return emission_; }
  std::uint32_t alike() const { return alike_; }  // of these, from the first on, that send the same
  float brightest() const { return brightest_; }  // of any place, any channel [W m^-2 sr^-1]

 private:
  std::vector<glm::vec3> emission_;
  std::uint32_t alike_ = 0;
  float brightest_;
};

}  // namespace lichtveld::lightfield
