// How peers find a way to each other (RFC 8445): the servers that help, and what came of it.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/stream/server.hpp"

namespace lichtveld::stream {

// As in WebRTC's RTCIceServer, one address each: stun:HOST[:PORT], turn:HOST[:PORT][?transport=udp|tcp] or
// turns:...
struct IceServer {
  std::string url;
  std::string username, credential;  // of TURN
  bool operator==(const IceServer&) const = default;
};

// What one peer connection is made with.
struct IceOptions {
  std::string bind_address;  // empty: every address
  UdpPorts ports;
  std::vector<IceServer> servers;
};

}  // namespace lichtveld::stream
