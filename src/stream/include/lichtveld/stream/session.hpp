// Who is in the room and who moves what. No network, no clock, no threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lichtveld/stream/place.hpp"

namespace lichtveld::stream {

using PeerNumber = std::uint64_t;

// What a peer is told about itself and the room.
struct Role {
  std::size_t cube = 0;  // 1 or 2; 0 watches
  std::size_t players = 0, watchers = 0;
  bool operator==(const Role&) const = default;
};

enum class MoveResult {
  moved,
  blocked,   // the cube stays where it is: a wall, the other cube
  watching,  // the peer has no cube
};

class Session {
 public:
  using Mover = std::function<Place(std::size_t cube, const std::vector<Place>& places, Move move)>;

  // At most this many cubes are given to players.
  static constexpr std::size_t max_players = 2;

  // The cubes at rest, and where a cube gets on a move (0 is the first cube; see ServerOptions::mover).
  // Throws std::invalid_argument for a place that is not finite or cubes without a mover.
  Session(std::vector<Place> places, Mover mover);

  // The first free cube, or a watcher's seat. A peer that is in the room already keeps what it has.
  void join(PeerNumber peer);

  // The leaver's cube, where it stands, goes to the watcher who has waited longest. Strangers are ignored.
  void leave(PeerNumber peer);

  // Moves the peer's cube. A mover's answer that is not finite leaves the cube where it is.
  MoveResult move(PeerNumber peer, Move move);

  Role role(PeerNumber peer) const;  // cube 0 for a stranger
  const std::vector<Place>& places() const { return places_; }
  std::size_t size() const { return seats_.size(); }
  std::size_t players() const;

 private:
  struct Seat {
    PeerNumber peer;
    std::size_t cube;  // 1-based; 0 watches
  };
  std::size_t free_cube() const;  // 0: none

  std::vector<Place> places_;
  Mover mover_;
  std::vector<Seat> seats_;  // by order of joining
};

}  // namespace lichtveld::stream
