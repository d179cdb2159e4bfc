#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <random>

#include "lichtveld/stream/encoder.hpp"

namespace lichtveld::stream {
namespace {

std::vector<std::uint8_t> noise(std::uint32_t size) {
  std::mt19937 random(size);
  std::vector<std::uint8_t> rgba(std::size_t{4} * size * size);
  for (auto& value : rgba) value = static_cast<std::uint8_t>(random());
  return rgba;
}

TEST(Encoder, PngGivesBackExactlyTheColours) {
  for (const std::uint32_t size : {1u, 2u, 17u, 256u})
    for (const int compression : {0, 1, 9}) {
      const auto rgba = noise(size);
      const auto png = encode_png(rgba, size, compression);
      ASSERT_GT(png.size(), 8u);
      EXPECT_EQ(std::vector<std::uint8_t>(png.begin(), png.begin() + 8),
                (std::vector<std::uint8_t>{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}));

      OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(png.data()), png.size());
      const auto input = OIIO::ImageInput::open("map.png", nullptr, &memory);
      ASSERT_TRUE(input) << OIIO::geterror();
      const OIIO::ImageSpec& spec = input->spec();
      EXPECT_EQ(spec.width, static_cast<int>(size));
      EXPECT_EQ(spec.height, static_cast<int>(size));
      EXPECT_EQ(spec.nchannels, 3);
      EXPECT_EQ(spec.format, OIIO::TypeDesc::UINT8);
      EXPECT_EQ(spec.get_string_attribute("oiio:ColorSpace"), "sRGB");
      std::vector<std::uint8_t> rgb(std::size_t{3} * size * size), expected;
      ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, rgb.data()));
      for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) expected.push_back(rgba[i]);
      EXPECT_EQ(rgb, expected) << size << " at level " << compression;
    }
}

TEST(Encoder, PngIsMarkedSrgb) {
  const auto png = encode_png(noise(2), 2);
  const std::string text(png.begin(), png.end());
  EXPECT_NE(text.find("sRGB"), std::string::npos);
}

TEST(Encoder, CompressionCompresses) {
  const std::vector<std::uint8_t> flat(std::size_t{4} * 64 * 64, 77);
  EXPECT_LT(encode_png(flat, 64, 1).size(), encode_png(flat, 64, 0).size() / 10);
}

TEST(Encoder, BadArgumentsAreNamed) {
  const std::vector<std::uint8_t> some(16);
  EXPECT_THROW(encode_png(some, 0), std::runtime_error);
  EXPECT_THROW(encode_png(some, 3), std::runtime_error);
  EXPECT_THROW(encode_png({}, 2), std::runtime_error);
  EXPECT_THROW(encode_png(some, 0xffffffffu), std::runtime_error);
  EXPECT_THROW(encode_png(some, 2, 10), std::runtime_error);
  EXPECT_THROW(encode_png(some, 2, -1), std::runtime_error);
}

}  // namespace
}  // namespace lichtveld::stream
