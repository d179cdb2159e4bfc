#include "signaling.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "limits.hpp"

namespace lichtveld::stream {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using namespace std::chrono_literals;

namespace {

constexpr auto connect_time = 5s;
// Without a word from signaling for half of this it is asked (a ping); after all of it, it is gone.
constexpr auto silence_time = 10s;
constexpr auto first_pause = 500ms, longest_pause = 10'000ms;
// The room is taken: most likely by our own predecessor, whom signaling has not given up yet.
constexpr auto taken_pause = 2000ms;
// A connection that has lasted this long starts the back-off anew.
constexpr auto settled_time = 5s;

}  // namespace

SignalingUrl SignalingUrl::parse(std::string_view url) {
  const auto bad = [&](const std::string& why) {
    return std::invalid_argument("signaling URL '" + std::string(url) + "': " + why +
                                 "; it looks like ws://127.0.0.1:8080/server");
  };
  constexpr std::string_view scheme = "ws://";
  if (!url.starts_with(scheme)) throw bad("it has to start with ws://");
  if (std::any_of(url.begin(), url.end(), [](char c) { return c <= ' ' || c > '~'; }))
    throw bad("only printable ASCII without spaces is allowed");
  const std::string_view rest = url.substr(scheme.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  std::string_view authority = rest.substr(0, slash);
  std::string_view host, port = "80";
  if (authority.starts_with('[')) {
    const std::size_t end = authority.find(']');
    if (end == std::string_view::npos) throw bad("'[' has no ']'");
    host = authority.substr(1, end - 1);
    authority.remove_prefix(end + 1);
    if (!authority.empty() && !authority.starts_with(':')) throw bad("after ']' comes :PORT");
  } else {
    host = authority.substr(0, authority.find(':'));
    authority.remove_prefix(host.size());
  }
  if (host.empty()) throw bad("it has no host");
  if (!authority.empty()) {
    port = authority.substr(1);
    unsigned number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error != std::errc() || end != port.data() + port.size() || number < 1 || number > 65535)
      throw bad("the port has to be a number from 1 to 65535");
  }
  return {std::string(host), std::string(port), slash < rest.size() ? std::string(rest.substr(slash)) : "/"};
}

Signaling::Signaling(asio::io_context& io, Options options, Events events)
    : io_(io), options_(std::move(options)), events_(std::move(events)), retry_(io) {
  asio::co_spawn(io_, stay_connected(), asio::detached);
}

asio::awaitable<void> Signaling::stay_connected() {
  while (true) {
    const Ending ending = co_await connect_once();
    if (ending == Ending::token_refused) co_return;
    retry_.expires_after(pause_after(ending));
    co_await retry_.async_wait(asio::use_awaitable);
  }
}

std::chrono::milliseconds Signaling::pause_after(Ending ending) {
  // A random share of the pause keeps many servers from coming back at the same moment.
  const auto longest =
      ending == Ending::room_taken ? 2 * taken_pause : std::min(longest_pause, first_pause * (2 << failures_));
  const auto shortest = ending == Ending::room_taken ? taken_pause : first_pause;
  failures_ = std::min(failures_ + 1, 8u);
  std::uniform_int_distribution<std::chrono::milliseconds::rep> pause(shortest.count(), longest.count());
  return std::chrono::milliseconds(pause(random_));
}

asio::awaitable<Signaling::Ending> Signaling::connect_once() {
  const auto& [host, port, target] = options_.url;
  websocket::response_type response;
  try {
    auto socket = std::make_shared<Socket>(io_);
    auto& tcp = beast::get_lowest_layer(*socket);
    tcp.expires_after(connect_time);
    asio::ip::tcp::resolver resolver(io_);
    const auto addresses = co_await resolver.async_resolve(host, port, asio::use_awaitable);
    co_await tcp.async_connect(addresses, asio::use_awaitable);
    tcp.socket().set_option(asio::ip::tcp::no_delay(true));
    tcp.expires_never();  // from here on the WebSocket keeps the time

    socket->set_option(websocket::stream_base::timeout{connect_time, silence_time, true});
    socket->set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(http::field::authorization, "Bearer " + options_.token);
      request.set("Lichtveld-Scene", options_.scene_hash);
    }));
    socket->read_message_max(limits::signaling_read);
    const std::string authority = host.find(':') == std::string::npos ? host : "[" + host + "]";
    co_await socket->async_handshake(response, authority + ":" + port, target, asio::use_awaitable);
    co_await receive(std::move(socket));
    co_return Ending::lost;
  } catch (const boost::system::system_error& error) {
    const std::string where = "signaling ws://" + host + ":" + port + target;
    if (error.code() != websocket::error::upgrade_declined) {
      spdlog::warn("{}: {}; trying again", where, error.code().message());
      co_return Ending::lost;
    }
    const std::string answer =
        "HTTP " + std::to_string(response.result_int()) + " " + response.body().substr(0, 200);
    if (response.result() == http::status::unauthorized) {
      spdlog::error("{} refused the token: {}", where, answer);
      events_.refused(where + " refused the token (" + answer + "); start both with the same token file");
      co_return Ending::token_refused;
    }
    if (response.result() == http::status::conflict) {
      spdlog::warn("{}: another render server holds the room; trying again until it leaves ({})", where,
                   answer);
      co_return Ending::room_taken;
    }
    spdlog::warn("{} declined: {}; trying again", where, answer);
    co_return Ending::lost;
  } catch (const std::exception& error) {
    spdlog::error("signaling: {}; trying again", error.what());
    co_return Ending::lost;
  }
}

asio::awaitable<void> Signaling::receive(std::shared_ptr<Socket> socket) {
  const auto start = std::chrono::steady_clock::now();
  socket_ = socket;
  queue_.clear();
  waiting_ = 0;
  spdlog::info("signaling {}:{} connected", options_.url.host, options_.url.port);
  events_.connected();

  boost::system::error_code error;
  beast::flat_buffer buffer;
  while (!error) {
    co_await socket->async_read(buffer, asio::redirect_error(asio::use_awaitable, error));
    if (!error) {
      const auto bytes = buffer.data();
      // A binary message is no JSON either way: what it says is refused by whoever parses it.
      events_.message({static_cast<const char*>(bytes.data()), bytes.size()});
      buffer.consume(buffer.size());
    }
  }
  // Ends a write that still waits: it holds the socket and this is the only place that reads from it.
  beast::get_lowest_layer(*socket).close();
  socket_.reset();
  queue_.clear();
  waiting_ = 0;
  if (std::chrono::steady_clock::now() - start > settled_time) failures_ = 0;
  spdlog::warn("signaling {}:{} lost ({}); running sessions go on", options_.url.host, options_.url.port,
               error.message());
  events_.lost();
}

void Signaling::send(std::string text) {
  if (!socket_) return;
  if (waiting_ >= limits::signaling_queue) {
    // Its other end takes nothing: the connection is as good as lost, and the reader will say so.
    beast::get_lowest_layer(*socket_).close();
    return;
  }
  waiting_ += text.size();
  queue_.push_back(std::move(text));
  if (queue_.size() == 1) write_next();
}

void Signaling::write_next() {
  socket_->text(true);
  // The handler owns socket and text: the queue may be another connection's by the time it runs.
  auto text = std::make_shared<std::string>(queue_.front());
  socket_->async_write(asio::buffer(*text),
                       [this, socket = socket_, text](boost::system::error_code error, std::size_t) {
                         if (error || socket != socket_)
                           return;  // the reader sees the same error and ends the connection
                         waiting_ -= queue_.front().size();
                         queue_.pop_front();
                         if (!queue_.empty()) write_next();
                       });
}

}  // namespace lichtveld::stream
