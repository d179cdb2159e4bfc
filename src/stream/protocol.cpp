#include "lichtveld/stream/protocol.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lichtveld::stream {

namespace {

void append(std::string& text, float value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a cube's place is not finite");
  // The longest shortest form is that of the smallest denormal: a sign, "0.", 44 zeros and a digit.
  std::array<char, 64> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed).ptr;
  text.append(digits.data(), end);
}

}  // namespace

std::string_view map_complete(MapFormat format) {
  switch (format) {
    case MapFormat::png:
      return "PNG_TRANSFER_COMPLETE";
  }
  throw std::logic_error("a map in no format");
}

std::span<const std::uint8_t> chunk_at(std::span<const std::uint8_t> map, std::size_t offset) {
  if (offset >= map.size()) return {};
  return map.subspan(offset, std::min(map_chunk, map.size() - offset));
}

std::string format_places(const std::vector<Place>& places) {
  std::string text;
  for (const Place& place : places) {
    if (!text.empty()) text += '/';
    append(text, place.x);
    text += '!';
    append(text, place.y);
  }
  return text;
}

std::optional<Move> parse_move(std::string_view text) {
  if (text == "up") return Move::up;
  if (text == "down") return Move::down;
  if (text == "left") return Move::left;
  if (text == "right") return Move::right;
  return std::nullopt;
}

std::string format_lights(const std::vector<Light>& lights, const std::string& sky) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& light : lights) {
    for (const float scale : light.scale)
      if (!(scale >= 0 && scale <= brightest_light))
        throw std::invalid_argument("a light's scale is outside 0.." + std::to_string(brightest_light));
    list.push_back({{"name", light.name.substr(0, light_name)}, {"scale", light.scale}});
  }
  nlohmann::ordered_json message = {{"lights", list}};
  if (!sky.empty()) message["sky"] = sky;
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::ignore);
}

bool asks_for_lights(std::string_view text) {
  return text == "lights";
}

std::optional<Dimming> parse_dimming(std::string_view text) {
  constexpr std::string_view start = "light ";
  if (!text.starts_with(start)) return std::nullopt;
  const char *at = text.data() + start.size(), *const end = text.data() + text.size();
  std::size_t number = 0;
  auto read = std::from_chars(at, end, number);
  if (read.ec != std::errc() || number == 0) return std::nullopt;
  Dimming dimming{.light = number - 1};
  std::size_t count = 0;
  while (read.ptr != end) {
    if (*read.ptr != ' ' || count == dimming.scale.size()) return std::nullopt;
    float& scale = dimming.scale[count++];
    read = std::from_chars(read.ptr + 1, end, scale, std::chars_format::fixed);
    if (read.ec != std::errc() || !(scale >= 0 && scale <= brightest_light)) return std::nullopt;
  }
  if (count != 1 && count != dimming.scale.size()) return std::nullopt;
  if (count == 1) dimming.scale.fill(dimming.scale[0]);
  return dimming;
}

}  // namespace lichtveld::stream
