#include "lichtveld/stream/encoder.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <stdexcept>
#include <string>

namespace lichtveld::stream {

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, std::uint32_t size, int compression) {
  const std::string what = "cannot encode a " + std::to_string(size) + " x " + std::to_string(size) + " PNG: ";
  const std::size_t bytes = std::size_t{4} * size * size;
  if (size == 0 || size > max_png_size)
    throw std::runtime_error(what + "the side has to be 1 to " + std::to_string(max_png_size));
  if (rgba.size() != bytes)
    throw std::runtime_error(what + "it takes " + std::to_string(bytes) + " bytes of RGBA, got " +
                             std::to_string(rgba.size()));
  if (compression < 0 || compression > 9)
    throw std::runtime_error(what + "compression " + std::to_string(compression) + " is not within 0 to 9");

  std::vector<std::uint8_t> png;
  OIIO::Filesystem::IOVecOutput memory(png);
  const auto output = OIIO::ImageOutput::create("map.png", &memory);
  if (!output) throw std::runtime_error(what + OIIO::geterror());

  const int side = static_cast<int>(size);
  OIIO::ImageSpec spec(side, side, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", compression);
  // The stride of four bytes a pixel skips alpha without a copy.
  if (!output->open("map.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, rgba.data(), 4) ||
      !output->close())
    throw std::runtime_error(what + output->geterror());
  return png;
}

}  // namespace lichtveld::stream
