// How the WebRTC library's threads reach a peer: functions posted to the room's thread, bounded, and none of
// them after the peer's end.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <memory>
#include <mutex>
#include <utility>

#include "limits.hpp"
#include "peer.hpp"

namespace lichtveld::stream {

class Peer::Mailbox : public std::enable_shared_from_this<Mailbox> {
 public:
  Mailbox(boost::asio::io_context& io, Peer& peer) : io_(&io), peer_(&peer) {}

  // For what a client can send in any number: beyond limits::queued_messages it is dropped and counted.
  template <typename Function>
  void post_bounded(Function function) {
    if (waiting_.fetch_add(1) >= limits::queued_messages) {
      --waiting_;
      ++dropped_;
      return;
    }
    post([this, function = std::move(function)](Peer& peer) mutable {
      --waiting_;
      function(peer);
    });
  }

  // For what comes a few times in a connection's life.
  template <typename Function>
  void post(Function function) {
    const std::lock_guard lock(mutex_);
    if (!io_) return;
    boost::asio::post(*io_, [self = shared_from_this(), function = std::move(function)]() mutable {
      if (self->peer_) function(*self->peer_);
    });
  }

  // At most one of these waits at a time.
  void post_pump() {
    if (pump_waits_.exchange(true)) return;
    post([this](Peer& peer) {
      pump_waits_ = false;
      peer.pump();
    });
  }

  // On the room's thread: nothing runs after this.
  void close() {
    peer_ = nullptr;
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

  std::size_t take_dropped() { return dropped_.exchange(0); }

 private:
  std::mutex mutex_;
  boost::asio::io_context* io_;  // null once closed; guarded by mutex_
  Peer* peer_;                   // the room's thread alone looks at it
  std::atomic<std::size_t> waiting_ = 0, dropped_ = 0;
  std::atomic<bool> pump_waits_ = false;
};

}  // namespace lichtveld::stream
