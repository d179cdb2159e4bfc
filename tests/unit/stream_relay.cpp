#include "stream_relay.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

namespace lichtveld::stream::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using nlohmann::json;

Relay::Relay(unsigned short port)
    : acceptor_(io_, {asio::ip::address_v4::loopback(), port}), port_(acceptor_.local_endpoint().port()) {
  listen();
  thread_ = std::jthread([this] { io_.run(); });
}

Relay::~Relay() {
  io_.stop();
  thread_.join();
}

void Relay::listen() {
  acceptor_.async_accept([this](boost::system::error_code error, tcp::socket tcp) {
    if (!error) greet(std::move(tcp));
    listen();
  });
}

// In one go, as whoever connects here speaks at once and reads. (It also spares the compiler a great deal.)
void Relay::greet(tcp::socket tcp) {
  beast::flat_buffer buffer;
  http::request<http::string_body> request;
  boost::system::error_code error;
  http::read(tcp, buffer, request, error);
  if (error) return;
  ++upgrades;
  const bool stranger = request[http::field::authorization] != std::string("Bearer ") + token;
  if (stranger || request.target() != "/server" || conflicts > 0) {
    if (!stranger) --conflicts;
    http::response<http::string_body> response(stranger ? http::status::unauthorized : http::status::conflict,
                                               11);
    response.set(http::field::content_type, "application/json");
    response.body() = stranger ? R"({"error":"wrong token"})" : R"({"error":"another server is here"})";
    response.prepare_payload();
    http::write(tcp, response, error);
    return;
  }
  auto socket = std::make_shared<Socket>(std::move(tcp));
  socket->accept(request, error);
  if (error) return;
  {
    const std::lock_guard lock(mutex_);
    scene_ = std::string(request["Lichtveld-Scene"]);
  }
  socket_ = std::move(socket);
  queue_.clear();
  buffer_.clear();
  send_raw(R"({"type":"welcome","id":"server"})");
  connected_ = true;  // after it, so that whatever a test sends comes later
  read_next();
}

void Relay::read_next() {
  socket_->async_read(buffer_, [this, socket = socket_](boost::system::error_code error, std::size_t) {
    if (socket != socket_) return;
    if (error) {
      connected_ = false;
      socket_.reset();
      return;
    }
    deliver(json::parse(beast::buffers_to_string(buffer_.data())));
    buffer_.clear();
    read_next();
  });
}

void Relay::deliver(const json& message) {
  Handler handler;
  {
    const std::lock_guard lock(mutex_);
    if (message.at("type") == "work") {
      work_ = message.dump();
      ++reports;
      return;
    }
    const auto client = clients_.find(message.at("id").get<int>());
    if (client != clients_.end()) handler = client->second;
  }
  if (handler) handler(message);
}

json Relay::work() const {
  const std::lock_guard lock(mutex_);
  return work_.empty() ? json() : json::parse(work_);
}

int Relay::attach(Handler handler) {
  const std::lock_guard lock(mutex_);
  clients_[++last_id_] = std::move(handler);
  return last_id_;
}

void Relay::detach(int id) {
  const std::lock_guard lock(mutex_);
  clients_.erase(id);
}

std::string Relay::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

void Relay::freeze(std::shared_future<void> until) {
  asio::post(io_, [until = std::move(until)] { until.wait(); });
}

void Relay::send_raw(std::string message) {
  asio::post(io_, [this, message = std::move(message)]() mutable {
    if (!socket_) return;
    queue_.push_back(std::move(message));
    if (queue_.size() == 1) write_next();
  });
}

void Relay::write_next() {
  auto text = std::make_shared<std::string>(queue_.front());
  socket_->async_write(asio::buffer(*text),
                       [this, text, socket = socket_](boost::system::error_code error, std::size_t) {
                         if (error || socket != socket_) return;
                         queue_.pop_front();
                         if (!queue_.empty()) write_next();
                       });
}

namespace {

sockaddr_in loopback(unsigned short port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

int udp_socket() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  const sockaddr_in address = loopback(0);
  if (socket < 0 || bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no UDP socket on 127.0.0.1");
  return socket;
}

}  // namespace

Link::Link(unsigned short server_port) : inside_(udp_socket()), outside_(udp_socket()) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  getsockname(inside_, reinterpret_cast<sockaddr*>(&address), &length);
  port_ = ntohs(address.sin_port);
  const sockaddr_in server = loopback(server_port);
  connect(outside_, reinterpret_cast<const sockaddr*>(&server), sizeof server);
  thread_ = std::jthread([this](std::stop_token stop) { forward(stop); });
}

Link::~Link() {
  thread_.request_stop();
  thread_.join();
  close(inside_);
  close(outside_);
}

void Link::forward(std::stop_token stop) {
  std::array<char, 65536> packet;
  sockaddr_in client = loopback(0);
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> ready{pollfd{inside_, POLLIN, 0}, pollfd{outside_, POLLIN, 0}};
    poll(ready.data(), ready.size(), 20);
    socklen_t length = sizeof client;
    if (ready[0].revents) {
      const auto size =
          recvfrom(inside_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&client), &length);
      if (size > 0 && !cut) send(outside_, packet.data(), static_cast<std::size_t>(size), 0);
    }
    if (ready[1].revents) {
      const auto size = recv(outside_, packet.data(), packet.size(), 0);
      if (size > 0 && !cut && client.sin_port != 0)
        sendto(inside_, packet.data(), static_cast<std::size_t>(size), 0,
               reinterpret_cast<const sockaddr*>(&client), sizeof client);
    }
  }
}

}  // namespace lichtveld::stream::test
