// The render server's side of a room on the network: signaling, peers, who moves what, and the newest map to
// everyone. It knows only bytes and places. It runs on a thread of its own; no call here waits for a client.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lichtveld/stream/light.hpp"
#include "lichtveld/stream/map.hpp"
#include "lichtveld/stream/place.hpp"
#include "lichtveld/stream/work.hpp"

namespace lichtveld::stream {

// The UDP ports that WebRTC may use, both from 1 to 65535 and in order.
struct UdpPorts {
  unsigned short first = 1024, last = 65535;
  bool one() const { return first == last; }
};

struct ServerOptions {
  std::string signaling;  // ws:// or wss://HOST[:PORT]/server
  std::string ca_file;    // PEM, the authorities that wss trusts; empty: the system's
  std::string token;      // the bearer token that signaling asks for: printable ASCII without spaces
  // The scene file's SHA-256 as 64 lower-case hex digits, sent to signaling for the greeting.
  std::string scene_hash;
  // The IP address that WebRTC binds to. Empty or a wildcard (0.0.0.0): every address but the loopback ones.
  std::string bind_address;
  // With one port all peers share it, and the server itself asks no TURN server.
  UdpPorts udp_ports = {};
  // The IP address at which this machine is reached behind a 1:1 NAT, which clients are told beside its own.
  // Empty: none.
  std::string public_address;
  std::vector<Place> places;  // the cubes at rest; at most two are given to players
  // Where a cube (0 is the first) gets when its player asks for a move, given all places: called on the
  // server's thread, must not block. Returns the cube's new place (the old one when it cannot move). Not needed
  // without cubes.
  std::function<Place(std::size_t cube, const std::vector<Place>& places, Move move)> mover;
  // Called on the server's thread whenever places have changed. Must not block. May be empty.
  std::function<void(const std::vector<Place>& places)> places_changed;
  // The lights that players may switch, as they are now; at most most_lights (protocol.hpp).
  std::vector<Light> lights = {};
  // Called on the server's thread when a player has changed one. Must not block. May be empty.
  std::function<void(const std::vector<Light>& lights)> lights_changed = {};
  // What there is to report besides the stage `send` and the counts of ServerStatistics, which are this
  // server's own: called on the server's thread twice a second. Must not block. May be empty.
  std::function<Work()> work;
};

// Throws std::invalid_argument for a signaling URL, ca_file, bind address, ports or public address that are
// none: what Server's constructor would throw, before anything costly is made for it. The rest may still be
// missing.
void check_addresses(const ServerOptions& options);

// What /metrics and the log show; counts since the start.
struct ServerStatistics {
  std::uint32_t peers = 0, players = 0;  // now, with an open channel; of these, with a cube
  // Maps sent whole (to the WebRTC library), and maps that a peer was too slow for; a map to two peers counts
  // twice.
  std::uint64_t maps_sent = 0, maps_skipped = 0, bytes_sent = 0;
  double seconds_sending = 0;                  // of the maps sent, each from when its peer could have it
  std::uint64_t moves = 0, moves_blocked = 0;  // blocked: at a wall or a cube, or asked for by a watcher
  std::uint64_t dimmings = 0;                  // of lights, by players
  // Messages (of clients and through signaling), channels and offers that were not understood, too long or too
  // many.
  std::uint64_t messages_refused = 0;
  std::uint64_t claims_refused = 0;  // of a cube, with the secret of nobody's stay or of one too long ago
  // Channels that opened, by the kinds of the two addresses, the server's first ("host_srflx"), and those that
  // did not, by the cause ("no_candidates", "no_pair", "no_channel").
  std::map<std::string, std::uint64_t> pairs, connect_failures;
  bool signaling_connected = false;
};

class Server {
 public:
  // Starts connecting to signaling and retries with back-off (0.5 .. 10 s) for as long as it lives; sessions
  // that run go on while signaling is away, and so do the retries while another server holds the room. Throws
  // std::invalid_argument for options that make no sense (a bad URL, an empty token, a bind address that is
  // none, cubes without a mover). A signaling server that refuses the token ends the retries: see refused().
  explicit Server(ServerOptions options);
  ~Server();  // closes every connection and joins the thread
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The newest map. It is kept for joiners and sent to every peer that is ready; a peer that is still receiving
  // gets the newest one when it is done. A peer is told the places of the map that it was sent last (before its
  // first one, the cubes' places of now), so that cubes and light agree on its screen. Returns at once.
  // Thread-safe. Throws std::invalid_argument for a map without bytes and a place that is not finite.
  void publish(EncodedMap map);

  ServerStatistics statistics() const;  // thread-safe

  // Empty, or why signaling will never have us: it refused the token. A sentence for the user. Thread-safe.
  std::string refused() const;

 private:
  struct Room;
  std::unique_ptr<Room> room_;
};

}  // namespace lichtveld::stream
