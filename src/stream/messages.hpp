// Signaling's messages as JSON. `id` names the other peer; the relay rewrites it, so what a server sends to
// {"id":7} arrives at client 7 with the server's id. Written by hand into the relay's and the browser's code
// too:
//
//   relay  -> server
//   {"type":"welcome","id":OWN,"iceServers":[{"urls":[URL,...],"username":U,"credential":C},...]}
//                      greeting; again when the credentials are about to expire
//   client -> server   {"id":C,"type":"offer","description":SDP,"session":SECRET of an earlier stay,
//                       "seat":"watcher","name":NAME}   seat and name are the relay's word
//   client -> server   {"id":C,"type":"candidate","candidate":LINE,"mid":"0"}
//   client -> server   {"id":C,"type":"rejoin","session":SECRET}   C is whom our open channel of that stay
//   leads to relay  -> server   {"id":C,"type":"gone"}                                 the client has left
//   server -> client   {"id":C,"type":"answer","description":SDP}
//   server -> client   {"id":C,"type":"candidate","candidate":LINE,"mid":"0"}
//   server -> client   {"id":C,"type":"role","cube":0|1|2,"players":N,"watchers":M,"session":SECRET}
//                      0 = watching
//   server -> relay    {"type":"work","stages":[{"name":"encode","runs":N,"seconds":S},...],"passes":[...],
//                       "counts":[{"name":"moves","value":N},...]}
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ice.hpp"
#include "lichtveld/stream/session.hpp"
#include "lichtveld/stream/work.hpp"

namespace lichtveld::stream {

struct Signal {
  enum class Type { welcome, offer, candidate, rejoin, gone };
  Type type;
  std::string id = {};                      // a string or a whole number, kept as the JSON text that it came as
  std::string body = {};                    // the SDP, or the candidate's line
  std::string mid = {};                     // of a candidate
  std::string session = {};                 // of an offer (may be empty) and a rejoin: what a role message told
  std::string name = {};                    // of an offer: the client's, for the log; may be empty
  bool watches = false;                     // of an offer: it may never play
  std::vector<IceServer> ice_servers = {};  // of a welcome
};

// Nothing for whatever is not one of the messages above in full and within the limits (limits.hpp).
std::optional<Signal> parse_signal(std::string_view text);

std::string answer_signal(const std::string& id, const std::string& sdp);
std::string candidate_signal(const std::string& id, const std::string& line, const std::string& mid);
std::string role_signal(const std::string& id, const Role& role, const std::string& session);
std::string work_signal(const Work& work);

}  // namespace lichtveld::stream
