#include <gmock/gmock.h>

#include <limits>
#include <numeric>

#include "lichtveld/stream/protocol.hpp"

namespace lichtveld::stream {
namespace {

std::vector<std::uint8_t> bytes(std::size_t count) {
  std::vector<std::uint8_t> result(count);
  std::iota(result.begin(), result.end(), std::uint8_t{0});
  return result;
}

TEST(Protocol, MapIsCutIntoChunksThatGiveItBack) {
  for (const std::size_t size : {std::size_t{1}, map_chunk - 1, map_chunk, map_chunk + 1, 3 * map_chunk}) {
    const auto png = bytes(size);
    std::vector<std::uint8_t> joined;
    std::size_t chunks = 0;
    while (true) {
      const auto chunk = chunk_at(png, joined.size());
      if (chunk.empty()) break;
      EXPECT_LE(chunk.size(), map_chunk);
      joined.insert(joined.end(), chunk.begin(), chunk.end());
      ++chunks;
    }
    EXPECT_EQ(joined, png);
    EXPECT_EQ(chunks, (size + map_chunk - 1) / map_chunk);
  }
  EXPECT_TRUE(chunk_at(bytes(3), std::numeric_limits<std::size_t>::max()).empty());
  EXPECT_LE(map_chunk, 64u * 1024u);
}

TEST(Protocol, FixedTexts) {
  EXPECT_EQ(map_complete(MapFormat::png), "PNG_TRANSFER_COMPLETE");
  EXPECT_EQ(channel_label, "lichtveld");
}

TEST(Protocol, PlacesAreShortDecimals) {
  EXPECT_EQ(format_places({{0.1f, -0.25f}, {1, 2.5f}}), "0.1!-0.25/1!2.5");
  EXPECT_EQ(format_places({{0.3f, 100000000.0f}}), "0.3!100000000");
  EXPECT_EQ(format_places({}), "");
  EXPECT_EQ(format_places({{1, 2}, {3, 4}, {5, 6}}), "1!2/3!4/5!6");
}

TEST(Protocol, PlacesReadBackExactlyAndWithoutExponent) {
  for (const float value : {1e-7f, 1.17549435e-38f, 3.4028235e38f, 1e-45f, -2.7182817f, 16777216.0f}) {
    const std::string text = format_places({{value, 0}});
    EXPECT_EQ(text.find_first_of("eE,"), std::string::npos) << text;
    EXPECT_EQ(std::strtof(text.c_str(), nullptr), value) << text;
  }
}

TEST(Protocol, PlacesThatAreNoNumbersAreRefused) {
  EXPECT_THROW(format_places({{std::numeric_limits<float>::quiet_NaN(), 0}}), std::invalid_argument);
  EXPECT_THROW(format_places({{0, std::numeric_limits<float>::infinity()}}), std::invalid_argument);
}

TEST(Protocol, MovesAreExactWords) {
  EXPECT_EQ(parse_move("up"), Move::up);
  EXPECT_EQ(parse_move("down"), Move::down);
  EXPECT_EQ(parse_move("left"), Move::left);
  EXPECT_EQ(parse_move("right"), Move::right);
  using namespace std::string_view_literals;
  for (const auto text : {""sv, "UP"sv, "up "sv, " up"sv, "up\n"sv, "up\0"sv, "u"sv, "upup"sv, "jump"sv,
                          "\xff\xfe"sv, "{\"move\":\"up\"}"sv})
    EXPECT_EQ(parse_move(text), std::nullopt) << text;
}

TEST(Protocol, LightsAreOneJsonText) {
  EXPECT_EQ(format_lights({}), R"({"lights":[]})");
  EXPECT_EQ(format_lights({}, "#0a80ff"), R"({"lights":[],"sky":"#0a80ff"})");
  EXPECT_EQ(format_lights({{"lamp", {1, 0.5f, 0}}, {"a\"b", {2, 2, 2}}}),
            R"({"lights":[{"name":"lamp","scale":[1.0,0.5,0.0]},{"name":"a\"b","scale":[2.0,2.0,2.0]}]})");
  EXPECT_LT(format_lights({{std::string(100'000, 'x'), {1, 1, 1}}}).size(), 200u);
  EXPECT_NO_THROW(format_lights({{"\xff\xfe", {1, 1, 1}}}));
  EXPECT_THROW(format_lights({{"lamp", {-1, 0, 0}}}), std::invalid_argument);
  EXPECT_THROW(format_lights({{"lamp", {std::nanf(""), 0, 0}}}), std::invalid_argument);
}

TEST(Protocol, ADimmingIsALightAndOneOrThreeScales) {
  EXPECT_EQ(parse_dimming("light 1 0.5"), (Dimming{0, {0.5f, 0.5f, 0.5f}}));
  EXPECT_EQ(parse_dimming("light 12 0 1 16"), (Dimming{11, {0, 1, 16}}));
  EXPECT_TRUE(asks_for_lights("lights"));
  for (const auto* text : {"",
                           "light",
                           "light ",
                           "light 1",
                           "light 0 1",
                           "light -1 1",
                           "light 1 -1",
                           "light 1 17",
                           "light 1 nan",
                           "light 1 inf",
                           "light 1 1e0",
                           "light 1 1 1",
                           "light 1 1 1 1 1",
                           "light 1  1",
                           "light 1 1 ",
                           "light 1,1",
                           "light 99999999999999999999 1",
                           "lights",
                           "Light 1 1",
                           "light 1 0x1"})
    EXPECT_EQ(parse_dimming(text), std::nullopt) << text;
}

}  // namespace
}  // namespace lichtveld::stream
