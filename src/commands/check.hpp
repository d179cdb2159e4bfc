// What `lichtveld check` says of a scene, in its three forms.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/lightfield/choice.hpp"
#include "lichtveld/scene/check.hpp"

namespace lichtveld::commands {

// What a bake with the defaults is expected to be, by short trials.
struct Outlook {
  std::string device, method;
  std::optional<lightfield::Expectation> expected;
  std::string why_not;  // where nothing is expected
};

struct CheckedScene {
  std::string file;
  double lumens_per_watt = 1;
  scene::SceneFacts facts;
  std::uint32_t texels_buried = 0;  // lightfield::BuriedTexels
  Outlook outlook;
};

// One page of text, lines ended by \n, without control characters.
std::string page_of(const CheckedScene& checked);

// The keys of docs/check.md.
nlohmann::ordered_json json_of(const CheckedScene& checked);

// The atlas as size * size sRGB pixels, RGBA, row 0 on top: v = 0 of TEXCOORD_1. A texel is a square of pixels.
struct Picture {
  std::uint32_t size = 0;  // pixels a side
  std::vector<std::uint8_t> rgba;
};
Picture picture_of(const scene::AtlasFacts& atlas);

// "point "bulb": 12 W", with lm where a watt has others than one.
std::string line_of(const scene::LightFacts& light, double lumens_per_watt = 1);

const char* name_of(scene::LightFacts::Kind kind);

}  // namespace lichtveld::commands
