// What the network tests need around the server: a signaling relay over a real WebSocket, clients with the real
// WebRTC library, and a UDP link that can be cut. Everything is bound to 127.0.0.1.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>

namespace lichtveld::stream::test {

// Plays signaling: one render server over a real WebSocket, clients in this process. Its end closes the
// connection.
class Relay {
 public:
  using Handler = std::function<void(const nlohmann::json& message)>;

  explicit Relay(unsigned short port = 0);
  ~Relay();

  unsigned short port() const { return port_; }
  std::string url() const { return "ws://127.0.0.1:" + std::to_string(port_) + "/server"; }

  // A client whose messages from the server go to `handler`, called on the relay's thread.
  int attach(Handler handler);
  void detach(int id);
  // `message` as it is, to the server.
  void send_raw(std::string message);

  // Does nothing more, not even answer pings, until `until` is ready; the connection stays.
  void freeze(std::shared_future<void> until);

  bool connected() const { return connected_; }
  nlohmann::json work() const;  // the newest report of what the server's work has taken; null before the first
  std::atomic<int> reports{0};  // of that, so far
  std::string scene() const;    // the header Lichtveld-Scene of the last accepted server
  std::atomic<int> conflicts{0};  // so many servers are told that the room is taken
  std::atomic<int> upgrades{0};   // requests so far
  static constexpr auto token = "the-right-token";

 private:
  using Socket = boost::beast::websocket::stream<boost::asio::ip::tcp::socket>;
  void listen();
  void greet(boost::asio::ip::tcp::socket tcp);
  void read_next();
  void deliver(const nlohmann::json& message);
  void write_next();

  boost::asio::io_context io_;
  boost::asio::ip::tcp::acceptor acceptor_;
  unsigned short port_;
  std::shared_ptr<Socket> socket_;
  boost::beast::flat_buffer buffer_;
  std::deque<std::string> queue_;
  std::atomic<bool> connected_ = false;
  mutable std::mutex mutex_;  // guards what follows
  std::map<int, Handler> clients_;
  int last_id_ = 0;
  std::string scene_;
  std::string work_;  // as JSON
  std::jthread thread_;
};

// A UDP path to the server that can be cut, which no WebRTC library does by itself.
class Link {
 public:
  // Forwards between a client, whoever writes to port(), and 127.0.0.1:server_port.
  explicit Link(unsigned short server_port);
  ~Link();
  unsigned short port() const { return port_; }

  // What comes while it is cut is lost.
  std::atomic<bool> cut{false};

 private:
  void forward(std::stop_token stop);
  int inside_, outside_;
  unsigned short port_;
  std::jthread thread_;
};

}  // namespace lichtveld::stream::test
