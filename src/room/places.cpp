#include "lichtveld/room/places.hpp"

#include <stdexcept>
#include <string>

#include "lichtveld/scene/motion.hpp"

namespace lichtveld::room {

namespace {

glm::vec3 unit(Direction direction) {
  switch (direction) {
    case Direction::left:
      return {-1, 0, 0};
    case Direction::right:
      return {1, 0, 0};
    case Direction::down:
      return {0, -1, 0};
    case Direction::up:
      return {0, 1, 0};
  }
  throw std::logic_error("no such direction");
}

}  // namespace

Places places_at_rest(const scene::Scene& scene, std::size_t most) {
  Places places;
  for (std::size_t body = 1; body < scene.bodies.size() && places.size() < most; ++body)
    places.push_back(scene.bodies[body].place);
  return places;
}

scene::Offsets offsets_of(const scene::Scene& scene, const Places& places) {
  if (places.size() + 1 > scene.bodies.size())
    throw std::invalid_argument(std::to_string(places.size()) + " places for " +
                                std::to_string(scene.bodies.size() - 1) + " movable bodies");
  scene::Offsets offsets(scene.bodies.size(), glm::vec3(0));
  for (std::size_t index = 0; index < places.size(); ++index)
    offsets[index + 1] = places[index] - scene.bodies[index + 1].place;
  return offsets;
}

glm::vec3 stepped(const scene::Scene& scene, const Places& places, std::size_t index, Direction direction) {
  const auto wanted = scene::step_length(scene) * unit(direction);
  const auto body = static_cast<std::uint32_t>(index + 1);
  return places.at(index) + scene::free_step(scene, offsets_of(scene, places), body, wanted);
}

}  // namespace lichtveld::room
