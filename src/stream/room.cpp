#include "room.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <stdexcept>
#include <utility>

#include "lichtveld/stream/protocol.hpp"

namespace lichtveld::stream {

namespace asio = boost::asio;

Server::Room::Room(ServerOptions options)
    : options_(std::move(options)),
      session_(options_.places, options_.mover),
      signaling_(
          io_, {SignalingUrl::parse(options_.signaling), options_.token, options_.scene_hash, options_.ca_file},
          {.connected = [this] { count([](auto& s) { s.signaling_connected = true; }); },
           .lost = [this] { signaling_lost(); },
           .message = [this](std::string_view text) { signal(text); },
           .refused =
               [this](std::string why) {
                 const std::lock_guard lock(mutex_);
                 refused_ = std::move(why);
               }}) {
  if (options_.lights.size() > most_lights)
    throw std::invalid_argument("a room tells of at most " + std::to_string(most_lights) + " lights");
  ice_.bind_address = options_.bind_address;
  ice_.ports = options_.udp_ports;
  tick();
  thread_ = std::jthread([this] { run(); });
}

Server::Room::~Room() {
  io_.stop();
  thread_.join();
  // Before the rest, as they post to the io_context until they are closed.
  guests_.clear();
}

void Server::Room::run() {
  while (!io_.stopped()) {
    try {
      io_.run();
    } catch (const std::exception& error) {
      // A mover that throws, or memory that has run out: one event is lost, the room goes on.
      spdlog::error("the room's thread: {}", error.what());
    }
  }
}

void Server::Room::publish(EncodedMap encoded) {
  if (encoded.bytes.empty()) throw std::invalid_argument("the published map has no bytes");
  auto map =
      std::make_shared<const Map>(Map{encoded.format, std::move(encoded.bytes), format_places(encoded.places)});
  asio::post(io_, [this, map = std::move(map), sky = std::move(encoded.sky)] {
    newest_ = map;
    if (std::exchange(sky_, sky) != sky) tell_lights();
    for (auto& [number, guest] : guests_) {
      if (!guest.peer->is_open()) continue;
      guest.peer->send_map(map);
      collect(*guest.peer);
    }
  });
}

ServerStatistics Server::Room::statistics() const {
  const std::lock_guard lock(mutex_);
  return statistics_;
}

std::string Server::Room::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

void Server::Room::tick() {
  // First: whatever fails below, the next one comes.
  tick_.expires_after(limits::places_interval);
  tick_.async_wait([this](boost::system::error_code error) {
    if (!error) tick();
  });
  const auto now = std::chrono::steady_clock::now();
  const std::string places = format_places(session_.places());
  for (auto it = guests_.begin(); it != guests_.end();) {
    const auto guest = it++;
    Peer& peer = *guest->second.peer;
    if (!peer.is_open()) {
      if (now - peer.created() > limits::open_time) {
        count_failure(guest->second);
        drop(guest, "its channel did not open in time");
      }
      continue;
    }
    peer.send_places(places);
    collect(peer);
    if (now - peer.outbox().last_empty() > limits::stall_time) drop(guest, "it takes nothing any more");
  }
  report();
}

void Server::Room::report() {
  const auto now = statistics();
  if (!now.signaling_connected) return;
  Work work;
  if (options_.work) work = options_.work();
  work.stages.push_back({"send", now.maps_sent, now.seconds_sending});
  for (const auto& [name, value] : {std::pair("maps_sent", now.maps_sent),
                                    {"maps_skipped", now.maps_skipped},
                                    {"moves", now.moves},
                                    {"moves_blocked", now.moves_blocked},
                                    {"dimmings", now.dimmings},
                                    {"messages_refused", now.messages_refused},
                                    {"claims_refused", now.claims_refused}})
    work.counts.push_back({name, value});
  for (const auto& [kinds, value] : now.pairs) work.counts.push_back({"pair_" + kinds, value});
  for (const auto& [cause, value] : now.connect_failures)
    work.counts.push_back({"connect_failed_" + cause, value});
  if (work == reported_) return;
  reported_ = work;
  signaling_.send(work_signal(work));
}

void Server::Room::on_open(Peer& peer) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end()) return;
  const auto joined = session_.join(peer.number(), guest->second.entry, std::chrono::steady_clock::now());
  const std::string pair = peer.pair();
  count([&](auto& s) {
    ++s.pairs[pair.empty() ? "unknown" : pair];
    if (joined.claim_refused) ++s.claims_refused;
  });
  if (joined.replaced)
    if (const auto old = guests_.find(*joined.replaced); old != guests_.end()) drop(old, "it came back anew");
  spdlog::info("peer {}{} joined by {}, {} in the room", peer.number(),
               guest->second.name.empty() ? "" : " (" + guest->second.name + ")", pair, session_.size());
  peer.send_places(format_places(session_.places()));
  if (newest_) peer.send_map(newest_);
  collect(peer);
  roles_changed();
}

void Server::Room::on_closed(Peer& peer) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end()) return;
  count_failure(guest->second);
  drop(guest, "it closed");
}

void Server::Room::count_failure(const Guest& guest) {
  if (guest.peer->is_open()) return;
  const std::string cause(guest.peer->why_not_open());
  count([&](auto& s) { ++s.connect_failures[cause]; });
}

void Server::Room::on_text(Peer& peer, std::string_view text) {
  const auto guest = guests_.find(peer.number());
  if (guest == guests_.end()) return;
  if (const auto move = parse_move(text)) return moved(guest->second, *move);
  const auto dimming = parse_dimming(text);
  if (dimming && dimming->light < options_.lights.size()) return dimmed(guest->second, *dimming);
  if (!asks_for_lights(text)) return on_refused(peer, "a text that is no move and no light");
  if (!guest->second.dimmings.take()) return count([](auto& s) { ++s.messages_refused; });
  guest->second.follows_lights = true;
  tell_lights(guest->second);
}

void Server::Room::moved(Guest& guest, Move move) {
  if (!guest.moves.take()) return count([](auto& s) { ++s.messages_refused; });
  const MoveResult result = session_.move(guest.peer->number(), move);
  count([&](auto& s) { ++(result == MoveResult::moved ? s.moves : s.moves_blocked); });
  if (result == MoveResult::moved && options_.places_changed) options_.places_changed(session_.places());
}

// Only who plays may: watchers see what players do.
void Server::Room::dimmed(Guest& guest, const Dimming& dimming) {
  if (!guest.dimmings.take() || session_.role(guest.peer->number()).cube == 0)
    return count([](auto& s) { ++s.messages_refused; });
  auto& scale = options_.lights[dimming.light].scale;
  if (scale == dimming.scale) return;
  scale = dimming.scale;
  count([](auto& s) { ++s.dimmings; });
  if (options_.lights_changed) options_.lights_changed(options_.lights);
  tell_lights();
}

void Server::Room::tell_lights() {
  for (auto& [number, guest] : guests_)
    if (guest.follows_lights) tell_lights(guest);
}

void Server::Room::tell_lights(Guest& guest) {
  if (!guest.peer->is_open()) return;
  guest.peer->send_lights(format_lights(options_.lights, sky_));
  collect(*guest.peer);
}

void Server::Room::on_refused(Peer& peer, std::string_view why) {
  refuse("peer " + std::to_string(peer.number()), why);
  const auto guest = guests_.find(peer.number());
  if (guest != guests_.end() && ++guest->second.refusals > limits::refusals)
    drop(guest, "too many refused messages");
}

void Server::Room::refuse(std::string_view who, std::string_view why) {
  count([](auto& s) { ++s.messages_refused; });
  if (log_.take()) spdlog::warn("refused from {}: {}", who, why);
}

void Server::Room::drop(Guests::iterator guest, std::string_view why) {
  const PeerNumber number = guest->first;
  spdlog::info("peer {} left: {}", number, why);
  collect(*guest->second.peer);
  guest->second.peer->mute();
  // Later, as this may be called from within the peer.
  asio::post(io_, [peer = std::move(guest->second.peer)] {});
  guests_.erase(guest);
  session_.leave(number, std::chrono::steady_clock::now());
  roles_changed();
}

void Server::Room::roles_changed() {
  count([&](auto& s) {
    s.peers = static_cast<std::uint32_t>(session_.size());
    s.players = static_cast<std::uint32_t>(session_.players());
  });
  if (std::exchange(roles_due_, true)) return;
  roles_timer_.expires_after(limits::roles_delay);
  roles_timer_.async_wait([this](boost::system::error_code error) {
    roles_due_ = false;
    if (!error) tell_roles();
  });
}

// A role is a state: each peer is told the newest, and one for whom there is no room now gets it the next time.
void Server::Room::tell_roles() {
  for (auto& [number, guest] : guests_) {
    if (!guest.peer->is_open() || guest.signaling_id.empty()) continue;
    const Role role = session_.role(number);
    if (guest.told == role) continue;
    if (signaling_.waiting() > limits::signaling_queue_of_roles) return roles_changed();
    guest.told = role;
    signaling_.send(role_signal(guest.signaling_id, role, guest.entry.secret));
  }
}

void Server::Room::collect(Peer& peer) {
  const SentCounts sent = peer.take_counts();
  const std::size_t dropped = peer.take_dropped();
  count([&](auto& s) {
    s.maps_sent += sent.maps;
    s.maps_skipped += sent.skipped;
    s.bytes_sent += sent.bytes;
    s.seconds_sending += sent.sending.count();
    s.messages_refused += dropped;
  });
}

}  // namespace lichtveld::stream
