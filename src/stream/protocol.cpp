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

std::span<const std::uint8_t> chunk_at(std::span<const std::uint8_t> png, std::size_t offset) {
  if (offset >= png.size()) return {};
  return png.subspan(offset, std::min(map_chunk, png.size() - offset));
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
