#include "core/lamps.hpp"

#include <algorithm>
#include <utility>

namespace lichtveld::lightfield {

float Lamps::strength(const glm::vec3& emission) {
  return std::max({emission.r, emission.g, emission.b});
}

bool Lamps::is_lamp(const glm::vec3& emission, float brightest) {
  return strength(emission) > dimmest * brightest;
}

Lamps::Lamps(std::vector<glm::vec3> emission, float brightest)
    : emission_(std::move(emission)), brightest_(brightest) {
  while (alike_ < count() && emission_[alike_] == emission_.front()) ++alike_;
}

}  // namespace lichtveld::lightfield
