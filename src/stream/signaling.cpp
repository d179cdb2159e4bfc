#include "signaling.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "lichtveld/stream/server.hpp"
#include "limits.hpp"
#include "tls.hpp"

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

// Null for ws.
std::shared_ptr<asio::ssl::context> tls_for(const SignalingUrl& url, const std::string& ca_file) {
  if (url.secure) return make_tls_context(ca_file);
  if (!ca_file.empty())
    throw std::invalid_argument("--ca-file is for wss://, and signaling is at " + url.text());
  return nullptr;
}

// What happens when one side speaks TLS and the other does not tells little by itself.
std::string in_words(const boost::system::error_code& error, bool secure) {
  if (secure && error.category() == asio::error::get_ssl_category())
    return error.message() + "; does it speak TLS? Without it the address starts with ws://";
  if (!secure && (error == http::error::bad_version || error == http::error::end_of_stream))
    return error.message() + "; does it speak TLS? Then the address starts with wss://";
  return error.message();
}

}  // namespace

void check_signaling(const std::string& url, const std::string& ca_file) {
  tls_for(SignalingUrl::parse(url), ca_file);
}

SignalingUrl SignalingUrl::parse(std::string_view url) {
  const auto bad = [&](const std::string& why) {
    return std::invalid_argument("signaling URL '" + std::string(url) + "': " + why +
                                 "; it looks like ws://127.0.0.1:8080/server or wss://room.example.org/server");
  };
  const bool secure = url.starts_with("wss://");
  if (!secure && !url.starts_with("ws://")) throw bad("it has to start with ws:// or wss://");
  const std::string_view scheme = secure ? "wss://" : "ws://";
  if (std::any_of(url.begin(), url.end(), [](char c) { return c <= ' ' || c > '~'; }))
    throw bad("only printable ASCII without spaces is allowed");
  const std::string_view rest = url.substr(scheme.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  std::string_view authority = rest.substr(0, slash);
  std::string_view host, port = secure ? "443" : "80";
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
  return {secure, std::string(host), std::string(port),
          slash < rest.size() ? std::string(rest.substr(slash)) : "/"};
}

std::string SignalingUrl::authority() const {
  return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + port;
}

std::string SignalingUrl::text() const {
  return (secure ? "wss://" : "ws://") + authority() + target;
}

Signaling::Signaling(asio::io_context& io, Options options, Events events)
    : io_(io), options_(std::move(options)), events_(std::move(events)), retry_(io) {
  tls_ = tls_for(options_.url, options_.ca_file);
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
  const auto& url = options_.url;
  const std::string where = "signaling " + url.text();
  const auto certificate_fault = std::make_shared<std::string>();
  websocket::response_type response;
  try {
    beast::tcp_stream tcp(io_);
    tcp.expires_after(connect_time);
    asio::ip::tcp::resolver resolver(io_);
    const auto addresses = co_await resolver.async_resolve(url.host, url.port, asio::use_awaitable);
    co_await tcp.async_connect(addresses, asio::use_awaitable);
    tcp.socket().set_option(asio::ip::tcp::no_delay(true));
    if (url.secure) {
      beast::ssl_stream<beast::tcp_stream> tls(std::move(tcp), *tls_);
      tls.set_verify_callback(CertificateCheck(url.host, certificate_fault));
      SSL_set_tlsext_host_name(tls.native_handle(), url.host.c_str());
      co_await tls.async_handshake(asio::ssl::stream_base::client, asio::use_awaitable);
      co_await converse(std::move(tls), response);
    } else {
      co_await converse(std::move(tcp), response);
    }
    co_return Ending::lost;
  } catch (const boost::system::system_error& error) {
    if (!certificate_fault->empty()) {
      spdlog::error("{}: {}; trying again", where, *certificate_fault);
      co_return Ending::lost;
    }
    if (error.code() != websocket::error::upgrade_declined) {
      spdlog::warn("{}: {}; trying again", where, in_words(error.code(), url.secure));
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

template <typename Below>
asio::awaitable<void> Signaling::converse(Below below, websocket::response_type& response) {
  auto socket = std::make_shared<websocket::stream<Below>>(std::move(below));
  beast::get_lowest_layer(*socket).expires_never();  // from here on the WebSocket keeps the time
  socket->set_option(websocket::stream_base::timeout{connect_time, silence_time, true});
  socket->set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::authorization, "Bearer " + options_.token);
    request.set("Lichtveld-Scene", options_.scene_hash);
  }));
  socket->read_message_max(limits::signaling_read);
  co_await socket->async_handshake(response, options_.url.authority(), options_.url.target,
                                   asio::use_awaitable);
  co_await receive(std::move(socket));
}

template <typename Socket>
asio::awaitable<void> Signaling::receive(std::shared_ptr<Socket> socket) {
  const auto start = std::chrono::steady_clock::now();
  const auto line = std::make_shared<Line>();
  line->write = [this, socket, weak = std::weak_ptr(line)](std::shared_ptr<std::string> text) {
    socket->text(true);
    // The handler owns socket and text: the queue may be another connection's by the time it runs.
    socket->async_write(asio::buffer(*text),
                        [this, socket, text, weak](boost::system::error_code error, std::size_t) {
                          written(weak.lock(), error);
                        });
  };
  line->close = [socket] { beast::get_lowest_layer(*socket).close(); };
  line_ = line;
  queue_.clear();
  waiting_ = 0;
  spdlog::info("{} connected", options_.url.text());
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
  line->close();
  line_.reset();
  queue_.clear();
  waiting_ = 0;
  if (std::chrono::steady_clock::now() - start > settled_time) failures_ = 0;
  spdlog::warn("{} lost ({}); running sessions go on", options_.url.text(), error.message());
  events_.lost();
}

void Signaling::send(std::string text) {
  if (!line_) return;
  if (waiting_ >= limits::signaling_queue) {
    // Its other end takes nothing: the connection is as good as lost, and the reader will say so.
    line_->close();
    return;
  }
  waiting_ += text.size();
  queue_.push_back(std::move(text));
  if (queue_.size() == 1) write_next();
}

void Signaling::write_next() {
  line_->write(std::make_shared<std::string>(queue_.front()));
}

void Signaling::written(const std::shared_ptr<Line>& line, boost::system::error_code error) {
  // The reader sees the same error and ends the connection.
  if (error || !line || line != line_) return;
  waiting_ -= queue_.front().size();
  queue_.pop_front();
  if (!queue_.empty()) write_next();
}

}  // namespace lichtveld::stream
