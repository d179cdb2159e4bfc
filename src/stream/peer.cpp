#include "peer.hpp"

#include <spdlog/spdlog.h>

#include <mutex>
#include <rtc/global.hpp>
#include <stdexcept>
#include <utility>

#include "lichtveld/stream/protocol.hpp"
#include "mailbox.hpp"
#include "token_bucket.hpp"

namespace lichtveld::stream {

namespace {

// Process-wide settings of the WebRTC library. Made before its first connection.
void set_up_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    rtc::InitLogger(rtc::LogLevel::Warning,
                    [mutex = std::make_shared<std::mutex>(),
                     lines = TokenBucket(limits::log_lines_per_second, limits::log_lines_burst)](
                        rtc::LogLevel, const std::string& message) mutable {
                      // Most of these are a client's doing, and it must not fill our log.
                      const std::lock_guard lock(*mutex);
                      if (lines.take()) spdlog::warn("webrtc: {}", message);
                    });
    // Of what waits in here nothing can be left out any more: on a line of 140 kB/s it is half a second of
    // light. A map every 33 ms at a round trip of 50 ms needs as much in flight.
    rtc::SctpSettings settings;
    settings.sendBufferSize = 64 * 1024;
    rtc::SetSctpSettings(settings);
  });
}

// Nothing for what the library does not speak (TURN over TCP or TLS) or cannot read. It would take a word
// without a scheme for a STUN server's name, and it asks only one of them.
std::optional<rtc::IceServer> usable(const IceServer& server, bool share_port) {
  if (!server.url.starts_with("stun:") && !server.url.starts_with("turn:")) return std::nullopt;
  try {
    rtc::IceServer found(server.url);
    if (found.type == rtc::IceServer::Type::Turn) {
      // Peers that share a port would share one allocation, too, which TURN does not know.
      if (share_port || found.relayType != rtc::IceServer::RelayType::TurnUdp) return std::nullopt;
      found.username = server.username;
      found.password = server.credential;
    }
    return found;
  } catch (const std::exception& error) {
    spdlog::warn("ICE server '{}' cannot be used: {}", server.url, error.what());
    return std::nullopt;
  }
}

rtc::Configuration configuration(const IceOptions& ice) {
  set_up_library();
  rtc::Configuration config;
  if (!ice.bind_address.empty()) config.bindAddress = ice.bind_address;
  config.portRangeBegin = ice.ports.first;
  config.portRangeEnd = ice.ports.last;
  config.enableIceUdpMux = ice.ports.one();
  for (const IceServer& server : ice.servers)
    if (auto found = usable(server, ice.ports.one())) config.iceServers.push_back(std::move(*found));
  // What a client may send in one message; it also bounds what is assembled in memory.
  config.maxMessageSize = 64 * 1024;
  return config;
}

// Nothing if the channel is the protocol's, or why not.
std::string_view unfit(const rtc::DataChannel& channel) {
  if (channel.label() != channel_label) return "a channel with another label";
  if (!channel.protocol().empty()) return "a sub-protocol that this server does not speak";
  const rtc::Reliability reliability = channel.reliability();
  if (reliability.unordered || reliability.maxRetransmits || reliability.maxPacketLifeTime)
    return "a channel that loses or reorders messages";
  if (channel.maxMessageSize() < map_chunk) return "a client that takes only tiny messages";
  return {};
}

// Whether a candidate may be used: an address (not a name) that UDP reaches.
bool reachable(rtc::Candidate& candidate) {
  return candidate.transportType() == rtc::Candidate::TransportType::Udp &&
         candidate.resolve(rtc::Candidate::ResolveMode::Simple);
}

std::string kind(const rtc::Candidate& candidate) {
  switch (candidate.type()) {
    case rtc::Candidate::Type::Host:
      return "host";
    case rtc::Candidate::Type::ServerReflexive:
      return "srflx";
    case rtc::Candidate::Type::PeerReflexive:
      return "prflx";
    case rtc::Candidate::Type::Relayed:
      return "relay";
    case rtc::Candidate::Type::Unknown:
      break;
  }
  return "unknown";
}

}  // namespace

Peer::Peer(PeerNumber number, boost::asio::io_context& io, PeerListener& listener, const IceOptions& ice)
    : number_(number),
      listener_(listener),
      mailbox_(std::make_shared<Mailbox>(io, *this)),
      connection_(configuration(ice)) {
  connection_.onLocalDescription([mailbox = mailbox_](const rtc::Description& description) {
    mailbox->post([sdp = std::string(description)](Peer& peer) { peer.listener_.on_answer(peer, sdp); });
  });
  connection_.onLocalCandidate([mailbox = mailbox_](const rtc::Candidate& candidate) {
    mailbox->post_bounded([candidate](Peer& peer) { peer.listener_.on_candidate(peer, candidate); });
  });
  connection_.onStateChange([mailbox = mailbox_](rtc::PeerConnection::State state) {
    using State = rtc::PeerConnection::State;
    if (state != State::Disconnected && state != State::Failed && state != State::Closed) return;
    mailbox->post([](Peer& peer) { peer.listener_.on_closed(peer); });
  });
  connection_.onDataChannel([mailbox = mailbox_](std::shared_ptr<rtc::DataChannel> channel) {
    mailbox->post_bounded([channel](Peer& peer) { peer.adopt(channel); });
    // Here and not in adopt(): messages that nobody takes would fill the library's queue and then block its
    // thread.
    listen(*channel, mailbox);
  });
}

Peer::~Peer() {
  mute();
  connection_.resetCallbacks();
  if (channel_) channel_->resetCallbacks();
  connection_.close();
}

void Peer::mute() {
  mailbox_->close();
}

std::size_t Peer::take_dropped() {
  return mailbox_->take_dropped();
}

void Peer::listen(rtc::DataChannel& channel, const std::shared_ptr<Mailbox>& mailbox) {
  // The channel's address only says later whether it is the one that was adopted.
  const rtc::DataChannel* const from = &channel;
  const auto refuse = [mailbox, from](std::string_view why) {
    mailbox->post_bounded([from, why](Peer& peer) {
      if (peer.channel_.get() == from) peer.listener_.on_refused(peer, why);
    });
  };
  channel.onMessage([refuse](const rtc::binary&) { refuse("a binary message"); },
                    [mailbox, from, refuse](std::string text) {
                      if (text.size() > max_client_message) return refuse("a message that is too long");
                      mailbox->post_bounded([from, text = std::move(text)](Peer& peer) {
                        if (peer.channel_.get() == from) peer.listener_.on_text(peer, text);
                      });
                    });
  channel.onBufferedAmountLow([mailbox] { mailbox->post_pump(); });
  channel.onClosed([mailbox, from] {
    mailbox->post([from](Peer& peer) {
      if (peer.channel_.get() == from) peer.listener_.on_closed(peer);
    });
  });
}

void Peer::adopt(std::shared_ptr<rtc::DataChannel> channel) {
  if (const auto why = channel_ ? "a second channel" : unfit(*channel); !why.empty()) {
    channel->close();
    listener_.on_refused(*this, why);
    return;
  }
  channel_ = std::move(channel);
  outbox_.emplace(channel_);
  listener_.on_open(*this);
}

void Peer::offer(const std::string& sdp) {
  rtc::Description description(sdp, rtc::Description::Type::Offer);
  if (!description.hasApplication() || description.mediaCount() != 1)
    throw std::invalid_argument("the offer is not of one data channel");
  for (rtc::Candidate& candidate : description.extractCandidates()) {
    if (!reachable(candidate)) continue;
    description.addCandidate(candidate);
    has_candidates_ = true;
  }
  connection_.setRemoteDescription(std::move(description));
}

void Peer::add_candidate(const std::string& line, const std::string& mid) {
  rtc::Candidate candidate(line, mid);
  if (!reachable(candidate)) return;
  connection_.addRemoteCandidate(std::move(candidate));
  has_candidates_ = true;
}

std::string Peer::pair() const {
  rtc::Candidate ours, theirs;
  if (!connection_.getSelectedCandidatePair(&ours, &theirs)) return {};
  return kind(ours) + "_" + kind(theirs);
}

std::string_view Peer::why_not_open() const {
  using State = rtc::PeerConnection::IceState;
  const State state = connection_.iceState();
  if (state == State::Connected || state == State::Completed) return "no_channel";
  return has_candidates_ ? "no_pair" : "no_candidates";
}

void Peer::pump() {
  if (!outbox_) return;
  try {
    outbox_->pump();
  } catch (const std::exception& error) {
    spdlog::debug("peer {}: {}", number_, error.what());
    mailbox_->post([](Peer& peer) { peer.listener_.on_closed(peer); });
  }
}

void Peer::send_map(std::shared_ptr<const Map> map) {
  outbox_->offer(std::move(map));
  pump();
}

void Peer::send_lights(const std::string& lights) {
  outbox_->tell_lights(lights);
  pump();
}

void Peer::send_places(const std::string& before_first_map) {
  outbox_->repeat_places(before_first_map);
  pump();
}

}  // namespace lichtveld::stream
