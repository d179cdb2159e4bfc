#include "lichtveld/stream/protocol.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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

}  // namespace lichtveld::stream
