#include "lichtveld/stream/server.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <optional>
#include <stdexcept>

#include "room.hpp"
#include "signaling.hpp"

namespace lichtveld::stream {

namespace {

std::optional<boost::asio::ip::address> address_of(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  return error ? std::nullopt : std::optional(address);
}

// Checks what Room does not.
ServerOptions checked(ServerOptions options) {
  if (options.token.empty()) throw std::invalid_argument("the signaling token is empty; is its file?");
  if (std::any_of(options.token.begin(), options.token.end(), [](char c) { return c <= ' ' || c > '~'; }))
    throw std::invalid_argument("the signaling token has other characters than printable ASCII without spaces");
  const auto hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (options.scene_hash.size() != 64 ||
      !std::all_of(options.scene_hash.begin(), options.scene_hash.end(), hex))
    throw std::invalid_argument("the scene's hash '" + options.scene_hash +
                                "' is not 64 lower-case hex digits");
  check_addresses(options);
  // The WebRTC library would offer the wildcard itself to clients.
  if (const auto bound = address_of(options.bind_address); bound && bound->is_unspecified())
    options.bind_address.clear();
  return options;
}

}  // namespace

void check_addresses(const ServerOptions& options) {
  check_signaling(options.signaling, options.ca_file);
  if (!options.bind_address.empty() && !address_of(options.bind_address))
    throw std::invalid_argument("cannot bind WebRTC to '" + options.bind_address + "': give an IP address");
  if (options.udp_ports.first == 0 || options.udp_ports.first > options.udp_ports.last)
    throw std::invalid_argument("the UDP ports have to be from 1 to 65535, the first one before the last");
  if (!options.public_address.empty() && !address_of(options.public_address))
    throw std::invalid_argument("the public address (--public-ip) '" + options.public_address +
                                "' is no IP address");
}

Server::Server(ServerOptions options) : room_(std::make_unique<Room>(checked(std::move(options)))) {}
Server::~Server() = default;
void Server::publish(EncodedMap map) {
  room_->publish(std::move(map));
}
ServerStatistics Server::statistics() const {
  return room_->statistics();
}
std::string Server::refused() const {
  return room_->refused();
}

}  // namespace lichtveld::stream
