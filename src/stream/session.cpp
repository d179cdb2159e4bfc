#include "lichtveld/stream/session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lichtveld::stream {

namespace {

bool finite(const Place& place) {
  return std::isfinite(place.x) && std::isfinite(place.y);
}

}  // namespace

Session::Session(std::vector<Place> places, Mover mover)
    : places_(std::move(places)), mover_(std::move(mover)) {
  if (!std::all_of(places_.begin(), places_.end(), finite))
    throw std::invalid_argument("a cube's place at rest is not finite");
  if (!places_.empty() && !mover_)
    throw std::invalid_argument("there are cubes but no mover that says where they go");
}

std::size_t Session::free_cube() const {
  for (std::size_t cube = 1; cube <= std::min(max_players, places_.size()); ++cube)
    if (std::none_of(seats_.begin(), seats_.end(), [&](const Seat& seat) { return seat.cube == cube; }))
      return cube;
  return 0;
}

void Session::join(PeerNumber peer) {
  if (std::any_of(seats_.begin(), seats_.end(), [&](const Seat& seat) { return seat.peer == peer; })) return;
  seats_.push_back({peer, free_cube()});
}

void Session::leave(PeerNumber peer) {
  const auto seat = std::find_if(seats_.begin(), seats_.end(), [&](const Seat& s) { return s.peer == peer; });
  if (seat == seats_.end()) return;
  seats_.erase(seat);
  const auto heir = std::find_if(seats_.begin(), seats_.end(), [](const Seat& s) { return s.cube == 0; });
  if (heir != seats_.end()) heir->cube = free_cube();
}

MoveResult Session::move(PeerNumber peer, Move move) {
  const std::size_t cube = role(peer).cube;
  if (cube == 0) return MoveResult::watching;
  const Place place = mover_(cube - 1, places_, move);
  if (!finite(place) || place == places_[cube - 1]) return MoveResult::blocked;
  places_[cube - 1] = place;
  return MoveResult::moved;
}

Role Session::role(PeerNumber peer) const {
  const auto seat = std::find_if(seats_.begin(), seats_.end(), [&](const Seat& s) { return s.peer == peer; });
  return {seat == seats_.end() ? 0 : seat->cube, players(), seats_.size() - players()};
}

std::size_t Session::players() const {
  return static_cast<std::size_t>(
      std::count_if(seats_.begin(), seats_.end(), [](const Seat& seat) { return seat.cube != 0; }));
}

}  // namespace lichtveld::stream
