#include "core/lamps.hpp"

#include <algorithm>

namespace lichtveld::lightfield {

float Lamps::strength(const glm::vec3& emission) {
  return std::max({emission.r, emission.g, emission.b});
}

bool Lamps::is_lamp(const glm::vec3& emission, float brightest) {
  return strength(emission) > dimmest * brightest;
}

Lamps::Lamps(const std::vector<glm::vec3>& emission_of_places) {
  for (const auto& emission : emission_of_places) brightest_ = std::max(brightest_, strength(emission));
  const auto end = std::ranges::find_if(
      emission_of_places, [&](const glm::vec3& emission) { return !is_lamp(emission, brightest_); });
  emission_.assign(emission_of_places.begin(), end);
  while (alike_ < count() && emission_[alike_] == emission_.front()) ++alike_;
}

}  // namespace lichtveld::lightfield
