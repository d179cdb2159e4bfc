// The live room: places in, maps out. It knows a scene, its light and the newest places; players, sockets and
// files are others' business.
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/room/places.hpp"
#include "lichtveld/room/work.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::room {

// Here is a map: what is to be shown, and the places that it shows.
struct Map {
  lightfield::Shown shown;
  Places places;
  scene::Scales scales = {};  // of the lights, as it shows them
};

// How fast the exposure of maps follows their light, as an eye does.
struct Eye {
  // Time constants where it becomes brighter, and darker [s]; 0: at once.
  double brighter = 0.3, darker = 0.9;
  std::optional<float> fixed = {};  // as lightfield::Adaptation::fixed
};

struct Options {
  double rate = 30;  // most maps a second, above 0
  Eye eye = {};
  scene::Scales scales = {};  // of its lights at the beginning; empty: all as in the scene
  // Of the scene's movable bodies the first so many are listed in maps and placed; others stand at rest.
  std::size_t bodies = std::numeric_limits<std::size_t>::max();
  // Where maps go, one after the other, on a thread of the room's own, while the next one is computed: to be
  // encoded and sent. What it throws ends run().
  std::function<void(Map map)> publish;
  // Asked between maps, on run()'s thread: true ends it. May be empty.
  std::function<bool()> ended = {};
  // Called for each map, on run()'s thread: calls what it is given once, which computes the map.
  std::function<void(const std::function<void()>& update)> around_update =
      [](const std::function<void()>& update) { update(); };
};

class Room {
 public:
  // The scene and what the light field uses must outlive it. Throws std::invalid_argument for options that make
  // no sense.
  Room(const scene::Scene& scene, std::unique_ptr<lightfield::LightField> light, Options options);
  ~Room();
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  // Publishes the map with all bodies at rest, of all its light. On the thread that uses the device, as run().
  void begin();

  // Follows the newest places and lights until stop(): a map as soon as somebody has changed something, then a
  // few more until the light has settled, then none; without a pause while a light flickers or follows a day.
  // Throws what the light field or `publish` throws.
  void run();

  // Where the bodies are now; of what comes while a map is made the newest counts. Thread-safe, and never
  // waits.
  void place(Places places);
  // What lights give times what the scene says, likewise. Their flicker and schedule come on top.
  void dim(scene::Scales scales);
  // Ends run() after the map that is being made, and makes a begin() that is under way end early. Thread-safe.
  void stop();

  // No map is published any more: returns when the one under way has been.
  void close();

  // Where body `index` of `places` gets with a step. Thread-safe.
  glm::vec3 stepped(const Places& places, std::size_t index, Direction direction);

  Work work() const;  // thread-safe

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace lichtveld::room
