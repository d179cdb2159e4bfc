// Where cubes are, and which way they are asked to go.
#pragma once

namespace lichtveld::stream {

// A cube's place in the scene's x, y plane [m].
struct Place {
  float x = 0, y = 0;
  bool operator==(const Place&) const = default;
};

enum class Move { up, down, left, right };

}  // namespace lichtveld::stream
