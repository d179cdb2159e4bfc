// The line to the signaling server: connects, proves itself with the token, comes back with back-off.
// Everything here runs on the io_context's thread, which must be one thread.
#pragma once

// Boost 1.74's awaitable.hpp uses std::exchange without including this; it has to come first.
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>

namespace lichtveld::stream {

struct SignalingUrl {
  bool secure = false;  // wss
  std::string host, port, target;

  // ws:// or wss://HOST[:PORT][/PATH]; an IPv6 address stands in brackets; the port is 80 or 443 where none is
  // given. Throws std::invalid_argument.
  static SignalingUrl parse(std::string_view url);

  std::string authority() const;  // HOST:PORT as in a URL
  std::string text() const;
};

// Throws std::invalid_argument for a URL or a ca_file that is none, or that the other has no use for.
void check_signaling(const std::string& url, const std::string& ca_file);

class Signaling {
 public:
  struct Options {
    SignalingUrl url;
    std::string token;       // printable ASCII without spaces
    std::string scene_hash;  // hex
    std::string ca_file;     // of wss, PEM; empty: the system's authorities
  };
  struct Events {
    std::function<void()> connected, lost;
    std::function<void(std::string_view text)> message;
    std::function<void(std::string why)> refused;  // the token is wrong: no further try is made
  };

  // Starts at once. The object must live until the io_context has stopped running. Throws std::invalid_argument
  // for a ca_file that is none, or has no use.
  Signaling(boost::asio::io_context& io, Options options, Events events);
  Signaling(const Signaling&) = delete;
  Signaling& operator=(const Signaling&) = delete;

  // Dropped while there is no connection: what it says is about clients whom signaling has forgotten by then.
  void send(std::string text);

  // Bytes that are still to be taken by the connection; 0 without one.
  std::size_t waiting() const { return waiting_; }

 private:
  // A WebSocket that is open, with or without TLS below it.
  struct Line {
    std::function<void(std::shared_ptr<std::string> text)> write;  // ends with a call of written()
    std::function<void()> close;
  };
  enum class Ending { lost, token_refused, room_taken };

  boost::asio::awaitable<void> stay_connected();
  boost::asio::awaitable<Ending> connect_once();
  template <typename Below>  // what carries the WebSocket
  boost::asio::awaitable<void> converse(Below below, boost::beast::websocket::response_type& response);
  template <typename Socket>
  boost::asio::awaitable<void> receive(std::shared_ptr<Socket> socket);
  void written(const std::shared_ptr<Line>& line, boost::system::error_code error);
  void write_next();
  std::chrono::milliseconds pause_after(Ending ending);

  boost::asio::io_context& io_;
  Options options_;
  Events events_;
  boost::asio::steady_timer retry_;
  std::shared_ptr<boost::asio::ssl::context> tls_;  // of wss
  std::shared_ptr<Line> line_;                      // set while connected
  std::deque<std::string> queue_;                   // its front is being written
  std::size_t waiting_ = 0;                         // bytes in queue_
  unsigned failures_ = 0;                           // in a row
  std::minstd_rand random_{std::random_device{}()};
};

}  // namespace lichtveld::stream
