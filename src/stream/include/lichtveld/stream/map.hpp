// A light map as it travels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lichtveld/stream/place.hpp"

namespace lichtveld::stream {

// How a map's bytes are to be read. What closes one on the wire: map_complete() in protocol.hpp.
enum class MapFormat {
  png,  // RGB of 8 bits, sRGB (encoder.hpp)
};

struct EncodedMap {
  MapFormat format = MapFormat::png;
  std::vector<std::uint8_t> bytes;
  std::vector<Place> places = {};  // that it shows
  std::string sky = {};            // what the sky looks like with it, "#rrggbb"; empty: there is none
};

}  // namespace lichtveld::stream
