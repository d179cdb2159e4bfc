// What one peer, or signaling, can make the room do: each limit with its unit and reason.
#pragma once

#include <chrono>
#include <cstddef>

namespace lichtveld::stream::limits {

using namespace std::chrono_literals;

// Peers at a time, those still connecting included; each costs a UDP port, some threads' time and up to 64 KiB
// of send buffer. Offers beyond it are refused.
inline constexpr std::size_t peers = 64;

// A peer's channel has to open within this time of its offer; on a bad network ICE takes a few seconds.
inline constexpr auto open_time = 15s;

// A peer that takes nothing from a full queue for this long has vanished, should nobody else have noticed:
// signaling says at once that a client is gone, SCTP itself gives up after some 13 s.
inline constexpr auto stall_time = 15s;

// The cubes' places go to everyone this often; the protocol asks for once a second.
inline constexpr auto places_interval = 500ms;

// Refused messages and channels (garbage, binary, oversize) before a peer is disconnected. Moves that come too
// fast are dropped and counted, but do not count here: a held key or a fast screen is no attack.
inline constexpr std::size_t refusals = 32;

// A player's moves: a token bucket, so that a key repeat or one move a frame at 60 Hz passes whole.
inline constexpr double moves_per_second = 60, moves_burst = 30;

// A player's changes of lights: a slider's, as fast as a screen. All who follow lights are told of each.
inline constexpr double dimmings_per_second = 60, dimmings_burst = 30;

// Messages of one peer that wait for the room's thread; more are dropped and counted. The rest of its events
// (opened, drained, closed) cannot pile up.
inline constexpr std::size_t queued_messages = 64;

// Offers that the room answers: each makes a certificate and sockets.
inline constexpr double offers_per_second = 20, offers_burst = 64;

// Bytes; a browser's offer of one data channel has about 700, a candidate about 120, a session's secret 22.
inline constexpr std::size_t description = 16 * 1024, candidate = 512, mid = 32, peer_id = 128, session = 64,
                             name = 160;

// STUN and TURN servers that a peer is given, and bytes of an address, a user's name, a credential. More only
// make the search for a way longer.
inline constexpr std::size_t ice_servers = 8, ice_server_text = 256;

// A peer that gives up after this long without a channel had no way to us; sooner it has only been closed.
inline constexpr auto patience = 5s;

// Roles are told together this long after the first change: when many leave in one moment each peer is told
// once.
inline constexpr auto roles_delay = 50ms;

// Candidates of one peer, both ways; a browser with many network interfaces has about 20.
inline constexpr std::size_t candidates = 64;

// A signaling message [bytes]: longer ones are refused up to the second limit, beyond which the connection
// ends.
inline constexpr std::size_t signaling_message = 32 * 1024, signaling_read = 1024 * 1024;

// Bytes to signaling that wait for a slow socket: 64 answers with their candidates are some 300 KiB. Roles do
// not count, they wait until there is room.
inline constexpr std::size_t signaling_queue = 4 * 1024 * 1024, signaling_queue_of_roles = 64 * 1024;

// Log lines about strangers' mistakes.
inline constexpr double log_lines_per_second = 1, log_lines_burst = 10;

}  // namespace lichtveld::stream::limits
