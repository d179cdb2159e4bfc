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

void Session::give_free_cubes() {
  for (Seat& seat : seats_)
    if (seat.cube == 0 && seat.may_play) seat.cube = free_cube();
}

Joined Session::join(PeerNumber peer, const Entry& entry, TimePoint now) {
  if (std::any_of(seats_.begin(), seats_.end(), [&](const Seat& seat) { return seat.peer == peer; })) return {};
  if (!entry.claim.empty()) {
    const auto own = std::find_if(seats_.begin(), seats_.end(),
                                  [&](const Seat& seat) { return seat.secret == entry.claim; });
    if (own != seats_.end()) {
      own->secret = entry.secret;
      own->may_play = entry.may_play;
      if (!own->may_play && std::exchange(own->cube, 0) != 0) give_free_cubes();
      return {.replaced = std::exchange(own->peer, peer)};
    }
  }
  Seat seat{peer, 0, entry.may_play, entry.secret};
  const bool taken_back = take_back(seat, entry.claim, now);
  seats_.push_back(std::move(seat));
  give_free_cubes();
  return {.claim_refused = !entry.claim.empty() && !taken_back};
}

void Session::forget_left(TimePoint now) {
  std::erase_if(left_, [&](const Left& left) { return now - left.when > claim_time; });
}

bool Session::take_back(Seat& claimant, const std::string& claim, TimePoint now) {
  forget_left(now);
  if (claim.empty() || !claimant.may_play) return false;
  const auto own =
      std::find_if(left_.begin(), left_.end(), [&](const Left& left) { return left.secret == claim; });
  if (own == left_.end()) return false;
  claimant.cube = own->cube;
  const auto heir =
      std::find_if(seats_.begin(), seats_.end(), [&](const Seat& seat) { return seat.cube == claimant.cube; });
  if (heir != seats_.end()) heir->cube = 0;
  // Who had it in between had it from this one, and gets it back no more.
  left_.erase(std::remove_if(own, left_.end(), [&](const Left& left) { return left.cube == claimant.cube; }),
              left_.end());
  return true;
}

void Session::leave(PeerNumber peer, TimePoint now) {
  const auto seat = std::find_if(seats_.begin(), seats_.end(), [&](const Seat& s) { return s.peer == peer; });
  if (seat == seats_.end()) return;
  forget_left(now);
  if (seat->cube != 0 && !seat->secret.empty()) left_.push_back({seat->secret, seat->cube, now});
  seats_.erase(seat);
  give_free_cubes();
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
