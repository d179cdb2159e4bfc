#include "messages.hpp"

#include <nlohmann/json.hpp>

#include "limits.hpp"

namespace lichtveld::stream {

namespace {

using nlohmann::json;

// A string member of 1 to `limit` bytes (0 too if `empty`).
std::optional<std::string> text_of(const json& message, const char* name, std::size_t limit,
                                   bool empty = false) {
  const auto member = message.find(name);
  if (member == message.end() || !member->is_string()) return std::nullopt;
  const auto& text = member->get_ref<const std::string&>();
  if (text.size() > limit || (text.empty() && !empty)) return std::nullopt;
  return text;
}

std::optional<std::string> id_of(const json& message) {
  const auto member = message.find("id");
  if (member == message.end() || !(member->is_string() || member->is_number_integer())) return std::nullopt;
  std::string id = member->dump();
  if (id.size() > limits::peer_id) return std::nullopt;
  return id;
}

// A secret that we may have made; nothing else is worth a look.
std::optional<std::string> session_of(const json& message) {
  return text_of(message, "session", limits::session);
}

// What there is of it and within the limits: a server that we cannot read is one that we do without.
std::vector<IceServer> ice_servers_of(const json& message) {
  std::vector<IceServer> servers;
  const auto list = message.find("iceServers");
  if (list == message.end() || !list->is_array()) return servers;
  for (const json& entry : *list) {
    if (!entry.is_object()) continue;
    const auto urls = entry.find("urls");
    if (urls == entry.end() || !urls->is_array()) continue;
    for (const json& url : *urls) {
      if (servers.size() >= limits::ice_servers) return servers;
      if (!url.is_string() || url.get_ref<const std::string&>().size() > limits::ice_server_text) continue;
      servers.push_back({url.get<std::string>(),
                         text_of(entry, "username", limits::ice_server_text).value_or(""),
                         text_of(entry, "credential", limits::ice_server_text).value_or("")});
    }
  }
  return servers;
}

// Replaces what is not UTF-8 rather than throw: the text comes from the WebRTC library.
std::string dump(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json work_of(const std::vector<WorkTime>& times) {
  json list = json::array();
  for (const auto& time : times)
    list.push_back({{"name", time.name}, {"runs", time.runs}, {"seconds", time.seconds}});
  return list;
}

}  // namespace

std::optional<Signal> parse_signal(std::string_view text) {
  if (text.size() > limits::signaling_message) return std::nullopt;
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return std::nullopt;
  const auto type = text_of(message, "type", 16);
  const auto id = id_of(message);
  if (!type || !id) return std::nullopt;

  if (*type == "welcome")
    return Signal{.type = Signal::Type::welcome, .id = *id, .ice_servers = ice_servers_of(message)};
  if (*type == "gone") return Signal{.type = Signal::Type::gone, .id = *id};
  if (*type == "offer") {
    auto sdp = text_of(message, "description", limits::description);
    if (!sdp) return std::nullopt;
    return Signal{.type = Signal::Type::offer,
                  .id = *id,
                  .body = std::move(*sdp),
                  .session = session_of(message).value_or(""),
                  .name = text_of(message, "name", limits::name).value_or(""),
                  .watches = message.value("seat", json()) == "watcher"};
  }
  if (*type == "rejoin") {
    auto session = session_of(message);
    if (!session) return std::nullopt;
    return Signal{.type = Signal::Type::rejoin, .id = *id, .session = std::move(*session)};
  }
  if (*type == "candidate") {
    // An empty line says that the client has no more candidates.
    auto line = text_of(message, "candidate", limits::candidate, true);
    auto mid = text_of(message, "mid", limits::mid);
    if (!line || !mid) return std::nullopt;
    return Signal{.type = Signal::Type::candidate, .id = *id, .body = std::move(*line), .mid = std::move(*mid)};
  }
  return std::nullopt;
}

std::string answer_signal(const std::string& id, const std::string& sdp) {
  return dump({{"id", json::parse(id)}, {"type", "answer"}, {"description", sdp}});
}

std::string candidate_signal(const std::string& id, const std::string& line, const std::string& mid) {
  return dump({{"id", json::parse(id)}, {"type", "candidate"}, {"candidate", line}, {"mid", mid}});
}

std::string role_signal(const std::string& id, const Role& role, const std::string& session) {
  return dump({{"id", json::parse(id)},
               {"type", "role"},
               {"cube", role.cube},
               {"players", role.players},
               {"watchers", role.watchers},
               {"session", session}});
}

std::string work_signal(const Work& work) {
  json counts = json::array();
  for (const auto& count : work.counts) counts.push_back({{"name", count.name}, {"value", count.value}});
  return dump({{"type", "work"},
               {"stages", work_of(work.stages)},
               {"passes", work_of(work.passes)},
               {"counts", counts}});
}

}  // namespace lichtveld::stream
