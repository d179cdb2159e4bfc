// The room's half of signaling: who may connect, and what is passed on.
#include <spdlog/spdlog.h>

#include <algorithm>

#include "room.hpp"

namespace lichtveld::stream {

void Server::Room::signaling_lost() {
  count([](auto& s) { s.signaling_connected = false; });
  // The next connection may give the same ids to others.
  for (auto& [number, guest] : guests_) guest.signaling_id.clear();
  reported_ = {};
}

void Server::Room::signal(std::string_view text) {
  const auto signal = parse_signal(text);
  if (!signal) return refuse("signaling", "a message that is malformed, unknown or too long");
  switch (signal->type) {
    case Signal::Type::welcome:
      return;
    case Signal::Type::offer:
      return offered(*signal);
    case Signal::Type::candidate:
      return candidate_came(*signal);
    case Signal::Type::gone:
      return client_gone(*signal);
  }
}

Server::Room::Guests::iterator Server::Room::find_by_signaling_id(const std::string& id) {
  return std::find_if(guests_.begin(), guests_.end(),
                      [&](const auto& entry) { return entry.second.signaling_id == id; });
}

void Server::Room::offered(const Signal& signal) {
  const std::string who = "client " + signal.id;
  if (!offers_.take()) return refuse(who, "an offer while too many come");
  // A second offer of the same client starts over: its page has made a new connection.
  if (const auto old = find_by_signaling_id(signal.id); old != guests_.end()) drop(old, "it offered anew");
  if (guests_.size() >= limits::peers) return refuse(who, "an offer while the room is full");

  const PeerNumber number = ++last_number_;
  try {
    auto peer = std::make_unique<Peer>(number, io_, *this, options_.bind_address);
    peer->offer(signal.body);
    Guest guest;
    guest.peer = std::move(peer);
    guest.signaling_id = signal.id;
    guests_.emplace(number, std::move(guest));
  } catch (const std::exception& error) {
    refuse(who, std::string("an offer that does not work: ") + error.what());
  }
}

void Server::Room::candidate_came(const Signal& signal) {
  const std::string who = "client " + signal.id;
  const auto found = find_by_signaling_id(signal.id);
  if (found == guests_.end()) return refuse(who, "a candidate without an offer");
  Guest& guest = found->second;
  if (++guest.candidates_in > limits::candidates) return refuse(who, "too many candidates");
  if (signal.body.empty()) return;  // the last one has come
  try {
    guest.peer->add_candidate(signal.body, signal.mid);
  } catch (const std::exception& error) {
    refuse(who, std::string("a candidate that is none: ") + error.what());
  }
}

void Server::Room::client_gone(const Signal& signal) {
  // A client's socket at signaling is its presence: a closed tab says nothing more through its channel, and
  // the small texts that go there would take long to fill a queue. Nothing of this comes when signaling itself
  // goes away.
  if (const auto found = find_by_signaling_id(signal.id); found != guests_.end())
    drop(found, "signaling says that it is gone");
}

void Server::Room::on_answer(Peer& peer, const std::string& sdp) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end() || guest->second.signaling_id.empty()) return;
  signaling_.send(answer_signal(guest->second.signaling_id, sdp));
}

void Server::Room::on_candidate(Peer& peer, const std::string& line, const std::string& mid) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end() || guest->second.signaling_id.empty()) return;
  if (++guest->second.candidates_out > limits::candidates) return;
  signaling_.send(candidate_signal(guest->second.signaling_id, line, mid));
}

}  // namespace lichtveld::stream
