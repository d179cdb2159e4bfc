// The room's event loop: one thread that owns the session, the peers and the line to signaling.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "lichtveld/stream/server.hpp"
#include "lichtveld/stream/session.hpp"
#include "limits.hpp"
#include "messages.hpp"
#include "peer.hpp"
#include "signaling.hpp"
#include "token_bucket.hpp"

namespace lichtveld::stream {

struct Server::Room final : PeerListener {
 public:
  explicit Room(ServerOptions options);  // throws as Server's constructor does
  ~Room();
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  // Thread-safe, as in Server.
  void publish(EncodedMap encoded);
  ServerStatistics statistics() const;
  std::string refused() const;

 private:
  struct Guest {
    std::unique_ptr<Peer> peer;
    std::string signaling_id;  // as in the present connection to signaling; empty once that is lost
    std::optional<Role> told;
    Entry entry;
    std::string name;  // empty: none was told
    std::size_t candidates_in = 0, candidates_out = 0, refusals = 0;
    TokenBucket moves{limits::moves_per_second, limits::moves_burst},
        dimmings{limits::dimmings_per_second, limits::dimmings_burst};
    bool follows_lights = false;
  };
  using Guests = std::map<PeerNumber, Guest>;

  void on_answer(Peer& peer, const std::string& sdp) override;
  void on_candidate(Peer& peer, const rtc::Candidate& candidate) override;
  void on_open(Peer& peer) override;
  void on_closed(Peer& peer) override;
  void on_text(Peer& peer, std::string_view text) override;
  void on_refused(Peer& peer, std::string_view why) override;

  void signaling_lost();
  void signal(std::string_view text);
  void offered(const Signal& signal);
  void candidate_came(const Signal& signal);
  void rejoined(const Signal& signal);
  void client_gone(const Signal& signal);

  void moved(Guest& guest, Move move);
  void dimmed(Guest& guest, const Dimming& dimming);
  void tell_lights();
  void tell_lights(Guest& guest);

  void run();
  void tick();
  void report();
  void refuse(std::string_view who, std::string_view why);
  void drop(Guests::iterator guest, std::string_view why);
  Guests::iterator find_by_signaling_id(const std::string& id);
  Guests::iterator find_by_secret(const std::string& secret);  // of those whose channel is open
  void count_failure(const Guest& guest);
  void roles_changed();
  void tell_roles();
  void collect(Peer& peer);
  template <typename Change>
  void count(Change change);

  boost::asio::io_context io_;  // first, so that it goes last: what waits in it refers to the rest
  ServerOptions options_;
  Session session_;
  Guests guests_;
  PeerNumber last_number_ = 0;
  std::shared_ptr<const Map> newest_;
  std::string sky_;  // of the newest map
  TokenBucket offers_{limits::offers_per_second, limits::offers_burst};
  TokenBucket log_{limits::log_lines_per_second, limits::log_lines_burst};
  boost::asio::steady_timer tick_{io_}, roles_timer_{io_};
  bool roles_due_ = false;
  IceOptions ice_;
  Work reported_;  // in the present connection to signaling
  Signaling signaling_;

  mutable std::mutex mutex_;  // guards the two below
  ServerStatistics statistics_;
  std::string refused_;

  std::jthread thread_;  // last, so that everything is there when it starts
};

template <typename Change>
void Server::Room::count(Change change) {
  const std::lock_guard lock(mutex_);
  change(statistics_);
}

}  // namespace lichtveld::stream
