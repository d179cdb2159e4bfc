// The room's half of signaling: who may connect, and what is passed on.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/uuid/random_generator.hpp>
#include <boost/uuid/uuid_io.hpp>

#include "room.hpp"

namespace lichtveld::stream {

namespace {

// Whether somebody who does not share our network could be told this address instead: ours, and of the same
// kind.
bool stands_for(const std::string& public_address, const rtc::Candidate& candidate) {
  if (public_address.empty() || candidate.type() != rtc::Candidate::Type::Host) return false;
  const auto address = candidate.address();
  boost::system::error_code error;
  const auto ours = boost::asio::ip::make_address(address.value_or(""), error);
  return !error && ours.is_v4() == boost::asio::ip::make_address(public_address).is_v4();
}

}  // namespace

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
      ice_.servers = signal->ice_servers;
      return;
    case Signal::Type::offer:
      return offered(*signal);
    case Signal::Type::candidate:
      return candidate_came(*signal);
    case Signal::Type::rejoin:
      return rejoined(*signal);
    case Signal::Type::gone:
      return client_gone(*signal);
  }
}

Server::Room::Guests::iterator Server::Room::find_by_signaling_id(const std::string& id) {
  return std::find_if(guests_.begin(), guests_.end(),
                      [&](const auto& entry) { return entry.second.signaling_id == id; });
}

Server::Room::Guests::iterator Server::Room::find_by_secret(const std::string& secret) {
  return std::find_if(guests_.begin(), guests_.end(), [&](const auto& entry) {
    return entry.second.peer->is_open() && entry.second.entry.secret == secret;
  });
}

void Server::Room::offered(const Signal& signal) {
  const std::string who = "client " + signal.id;
  if (!offers_.take()) return refuse(who, "an offer while too many come");
  // A second offer of the same client starts over: its page has made a new connection.
  if (const auto old = find_by_signaling_id(signal.id); old != guests_.end()) drop(old, "it offered anew");
  // Somebody who comes back may still be here, on a way that is dead.
  const bool comes_back = find_by_secret(signal.session) != guests_.end();
  if (guests_.size() >= limits::peers && !comes_back) return refuse(who, "an offer while the room is full");

  const PeerNumber number = ++last_number_;
  try {
    auto peer = std::make_unique<Peer>(number, io_, *this, ice_);
    peer->offer(signal.body);
    Guest guest;
    guest.peer = std::move(peer);
    guest.signaling_id = signal.id;
    guest.name = signal.name;
    guest.entry = {.may_play = !signal.watches,
                   .secret = to_string(boost::uuids::random_generator()()),
                   .claim = signal.session};
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

void Server::Room::rejoined(const Signal& signal) {
  const auto guest = find_by_secret(signal.session);
  const auto other = find_by_signaling_id(signal.id);
  if (guest == guests_.end() || (other != guests_.end() && other != guest)) {
    count([](auto& s) { ++s.claims_refused; });
    return refuse("client " + signal.id, "a stay that is none of ours");
  }
  guest->second.signaling_id = signal.id;
  guest->second.told.reset();
  roles_changed();
}

void Server::Room::client_gone(const Signal& signal) {
  // A client's socket at signaling is its presence: a closed tab says nothing more through its channel, and
  // the small texts that go there would take long to fill a queue. Nothing of this comes when signaling itself
  // goes away.
  const auto found = find_by_signaling_id(signal.id);
  if (found == guests_.end()) return;
  if (std::chrono::steady_clock::now() - found->second.peer->created() > limits::patience)
    count_failure(found->second);
  drop(found, "signaling says that it is gone");
}

void Server::Room::on_answer(Peer& peer, const std::string& sdp) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end() || guest->second.signaling_id.empty()) return;
  signaling_.send(answer_signal(guest->second.signaling_id, sdp));
}

void Server::Room::on_candidate(Peer& peer, const rtc::Candidate& candidate) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end() || guest->second.signaling_id.empty()) return;
  const auto tell = [&, &guest = guest->second](const rtc::Candidate& told) {
    if (++guest.candidates_out > limits::candidates) return;
    signaling_.send(candidate_signal(guest.signaling_id, told.candidate(), told.mid()));
  };
  tell(candidate);
  if (!stands_for(options_.public_address, candidate)) return;
  rtc::Candidate outside = candidate;
  outside.changeAddress(options_.public_address);
  tell(outside);
}

}  // namespace lichtveld::stream
