// Who is in the room and who moves what. No network, no clock of its own, no threads.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
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

// What a peer comes with.
struct Entry {
  bool may_play = true;  // false: it never gets a cube
  // Its own for this stay, known to it and to us: by it the peer gets back what it had. Empty: nothing to get
  // back.
  std::string secret = {};
  std::string claim = {};  // the secret of an earlier stay, whose seat it asks for; empty: none
};

struct Joined {
  bool claim_refused = false;  // there was a claim, and nothing (any more) that it fits
  // The peer whose seat this one has taken: the same person, connected anew.
  std::optional<PeerNumber> replaced = {};
};

enum class MoveResult {
  moved,
  blocked,   // the cube stays where it is: a wall, the other cube
  watching,  // the peer has no cube
};

class Session {
 public:
  using Mover = std::function<Place(std::size_t cube, const std::vector<Place>& places, Move move)>;

  using TimePoint = std::chrono::steady_clock::time_point;

  // At most this many cubes are given to players.
  static constexpr std::size_t max_players = 2;

  // So long after its leave a player gets its cube back, whoever has it by then: enough for a network that is
  // gone for some seconds, a reload, a browser that is started again.
  static constexpr std::chrono::seconds claim_time{30};

  // The cubes at rest, and where a cube gets on a move (0 is the first cube; see ServerOptions::mover).
  // Throws std::invalid_argument for a place that is not finite or cubes without a mover.
  Session(std::vector<Place> places, Mover mover);

  // The first free cube, or a watcher's seat; with a claim that fits, what that stay had: the seat of a peer
  // that is still there, or the cube of one that left within claim_time, whose present holder watches again. A
  // peer that is in the room already keeps what it has.
  Joined join(PeerNumber peer, const Entry& entry = {}, TimePoint now = {});

  // The leaver's cube, where it stands, goes to the watcher who has waited longest. Strangers are ignored.
  void leave(PeerNumber peer, TimePoint now = {});

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
    bool may_play;
    std::string secret;
  };
  // A cube whose player has left.
  struct Left {
    std::string secret;
    std::size_t cube;
    TimePoint when;
  };
  std::size_t free_cube() const;    // 0: none
  void give_free_cubes();           // to those who have waited longest
  void forget_left(TimePoint now);  // whose claim_time is over
  bool take_back(Seat& claimant, const std::string& claim, TimePoint now);

  std::vector<Place> places_;
  Mover mover_;
  std::vector<Seat> seats_;  // by order of joining
  std::vector<Left> left_;   // by time
};

}  // namespace lichtveld::stream
