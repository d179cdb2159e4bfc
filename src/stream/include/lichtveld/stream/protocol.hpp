// The data channel's protocol, version 1, as bytes: what a message looks like, nothing about sending it.
//
//   server -> client   binary  one PNG in chunks of at most map_chunk bytes, in order
//                      text    PNG_TRANSFER_COMPLETE after the last chunk
//                      text    x1!y1/x2!y2, the cubes' places [m]; may come between two chunks
//                      text    {"lights":[..]}, what lights give, to a client that has asked for it
//   client -> server   text    up | down | left | right
//                      text    lights; light N S | light N R G B
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lichtveld/stream/light.hpp"
#include "lichtveld/stream/map.hpp"
#include "lichtveld/stream/place.hpp"

namespace lichtveld::stream {

// The channel's label; its sub-protocol is empty in version 1.
inline constexpr std::string_view channel_label = "lichtveld";

// Bytes of a map in one message. 16 KiB is what every WebRTC implementation takes; one message blocks those
// behind it, so a places message never waits for more than this in our own queue.
inline constexpr std::size_t map_chunk = 16 * 1024;

// The text after a map's last chunk, by which a client also knows its format.
std::string_view map_complete(MapFormat format);

// The longest message that a client may send [bytes].
inline constexpr std::size_t max_client_message = 64;

// The chunk of a map that starts at `offset` (at most map_chunk bytes; empty at or past the end).
std::span<const std::uint8_t> chunk_at(std::span<const std::uint8_t> map, std::size_t offset);

// "x1!y1/x2!y2": plain decimals (no exponent, a point in every locale), the shortest that read back as the same
// float; one entry a cube, in order; empty without cubes, and then there is nothing to send. Throws
// std::invalid_argument for a place that is not finite.
std::string format_places(const std::vector<Place>& places);

// Exactly `up`, `down`, `left` or `right`; nothing for anything else.
std::optional<Move> parse_move(std::string_view text);

// A light may be made so many times as bright as the scene says, and a room tells of so many lights, by so many
// bytes of a name.
inline constexpr float brightest_light = 16;
inline constexpr std::size_t most_lights = 64, light_name = 64;

// {"lights":[{"name":"lamp","scale":[1,1,1]}],"sky":"#8fb4e8"}, in the order in which `light` numbers them;
// without "sky" where that is empty. Throws std::invalid_argument for a scale that is not 0..brightest_light.
std::string format_lights(const std::vector<Light>& lights, const std::string& sky = {});

// Whether a client asks to be told of lights, now and whenever they change.
bool asks_for_lights(std::string_view text);

// Exactly `light N S` or `light N R G B`: N from 1, scales plain decimals of 0..brightest_light; nothing for
// anything else.
std::optional<Dimming> parse_dimming(std::string_view text);

}  // namespace lichtveld::stream
