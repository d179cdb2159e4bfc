// One client: its WebRTC connection and the one data channel that counts. The library's callbacks run on its
// own threads; they only post into the room's io_context, whose single thread owns everything here.
#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <rtc/peerconnection.hpp>
#include <string>
#include <string_view>

#include "ice.hpp"
#include "lichtveld/stream/session.hpp"
#include "outbox.hpp"

namespace lichtveld::stream {

class Peer;

// What a peer tells the room, on the room's thread. The room must not destroy the peer within the call.
class PeerListener {
 public:
  virtual void on_answer(Peer& peer, const std::string& sdp) = 0;
  virtual void on_candidate(Peer& peer, const rtc::Candidate& candidate) = 0;
  virtual void on_open(Peer& peer) = 0;
  virtual void on_closed(Peer& peer) = 0;
  virtual void on_text(Peer& peer, std::string_view text) = 0;
  // A channel or message that the protocol does not know: why.
  virtual void on_refused(Peer& peer, std::string_view why) = 0;

 protected:
  ~PeerListener() = default;
};

class Peer {
 public:
  Peer(PeerNumber number, boost::asio::io_context& io, PeerListener& listener, const IceOptions& ice);
  ~Peer();  // closes the connection; no call to the listener follows
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  PeerNumber number() const { return number_; }

  // A client's offer of one data channel. Throws std::exception when it is anything else.
  void offer(const std::string& sdp);

  // One of the client's addresses. Names are left out, not looked up: a stranger must not make us ask the DNS.
  // Throws std::exception for what is no candidate, or comes before the offer.
  void add_candidate(const std::string& line, const std::string& mid);

  bool is_open() const { return outbox_.has_value(); }

  // The kinds of the two addresses that found each other, ours first: host, srflx, prflx or relay, as in
  // "host_srflx". Empty before any did.
  std::string pair() const;

  // Why its channel has not opened: "no_candidates" (the client named no address that could be tried),
  // "no_pair" (none answered), "no_channel".
  std::string_view why_not_open() const;

  std::chrono::steady_clock::time_point created() const { return created_; }

  // Only while open. What cannot be sent because the channel has just closed is followed by on_closed.
  void send_map(std::shared_ptr<const Map> map);
  void send_places(const std::string& before_first_map);
  void send_lights(const std::string& lights);
  const Outbox& outbox() const { return *outbox_; }

  SentCounts take_counts() { return outbox_ ? outbox_->take_counts() : SentCounts{}; }

  // Messages dropped since the last call because the room was too busy to take them.
  std::size_t take_dropped();

  // No call to the listener from now on.
  void mute();

 private:
  class Mailbox;

  static void listen(rtc::DataChannel& channel, const std::shared_ptr<Mailbox>& mailbox);
  void adopt(std::shared_ptr<rtc::DataChannel> channel);
  void pump();

  PeerNumber number_;
  PeerListener& listener_;
  std::chrono::steady_clock::time_point created_ = std::chrono::steady_clock::now();
  std::shared_ptr<Mailbox> mailbox_;
  bool has_candidates_ = false;  // of the client, that can be tried
  mutable rtc::PeerConnection connection_;
  std::shared_ptr<rtc::DataChannel> channel_;
  std::optional<Outbox> outbox_;
};

}  // namespace lichtveld::stream
