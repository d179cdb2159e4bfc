#include "mutate.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <string_view>

namespace lichtveld::mutants {
namespace {

using nlohmann::json;

// Distributions of the standard library differ between libraries; these do not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
  bool once_in(std::size_t count) { return below(count) == 0; }
  char byte() { return static_cast<char>(bits_()); }
  template <typename List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937_64 bits_;
};

std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

// Floats and whole numbers that ask for care, as the bits of a word: NaN, infinities, the largest, the
// smallest, 1e20, a million, halves, signs.
constexpr std::uint32_t odd_words[] = {0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 0x00000001, 0x60ad78ec,
                                       0x49742400, 0xc9742400, 0x3f000000, 0xbf800000, 0x00000000, 0x80000000,
                                       0xffffffff, 0x7fffffff, 0x0000ffff, 0x00010000, 0x35000000, 0x3f800000};

// A word of a buffer, most of which are floats: to one that asks for care, a multiple, or another's value. Such
// damage often gets past everything that is checked.
std::string damage_word(std::string& bytes, Random& random) {
  const std::size_t words = bytes.size() / 4;
  if (words == 0) return "nothing";
  const std::size_t at = 4 * random.below(words), from = 4 * random.below(words);
  const auto put = [&](const std::string& word) { bytes.replace(at, 4, word); };
  const auto as_float = [&] {
    float value = 0;
    std::memcpy(&value, &bytes[at], 4);
    return value;
  };
  switch (random.below(4)) {
    case 0:
      put(little_endian(random.of(odd_words), 4));
      break;
    case 1: {  // all components of a vector
      const std::string vector = bytes.substr(from, 4 * (1 + random.below(4)));
      bytes.replace(at, vector.size(), vector);
      break;
    }
    case 2:
      put(bytes.substr(from, 4));
      break;
    default: {
      constexpr float factors[] = {0, -1, 2, 0.5f, 1e3f, 1e-3f, 1e-20f, 1.000001f, 3e5f};
      put(little_endian(std::bit_cast<std::uint32_t>(as_float() * random.of(factors)), 4));
    }
  }
  return fmt::format("word at {} now {}", at, as_float());
}

// Changes `bytes`, and says how.
std::string damage_bytes(std::string& bytes, Random& random) {
  if (bytes.empty()) {
    bytes = std::string(1 + random.below(64), random.byte());
    return "filled";
  }
  const std::size_t at = random.below(bytes.size()),
                    some = std::min(bytes.size() - at, 1 + random.below(random.once_in(4) ? bytes.size() : 16));
  switch (random.below(10)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << random.below(8));
      return fmt::format("bit of byte {} flipped", at);
    case 1:
      bytes[at] = random.byte();
      return fmt::format("byte {} overwritten", at);
    case 2:
    case 3: {
      const std::size_t word = at / 4 * 4;
      const std::string value = little_endian(random.of(odd_words), 4);
      bytes.replace(word, std::min<std::size_t>(4, bytes.size() - word), value);
      return fmt::format("word at {} replaced", word);
    }
    case 4:
      bytes.erase(at, some);
      return fmt::format("{} bytes at {} deleted", some, at);
    case 5:
      bytes.insert(at, bytes.substr(at, some));
      return fmt::format("{} bytes at {} doubled", some, at);
    case 6:
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), some, random.once_in(2) ? '\0' : '\xff');
      return fmt::format("{} bytes at {} blotted out", some, at);
    case 7:
      for (std::size_t i = 0; i < some; ++i) bytes[at + i] = random.byte();
      return fmt::format("{} bytes at {} random", some, at);
    case 8: {  // what stands elsewhere
      const std::string other = bytes.substr(random.below(bytes.size()), some);
      bytes.replace(at, other.size(), other);
      return fmt::format("{} bytes moved to {}", other.size(), at);
    }
    default:
      bytes.resize(at);
      return fmt::format("cut to {} bytes", at);
  }
}

// A value of the JSON with the one it is in.
struct Place {
  json* value;
  json* parent;     // null for the root
  std::string key;  // in an object; in an array its number
};

void collect(json& value, json* parent, const std::string& key, std::vector<Place>& places) {
  places.push_back({&value, parent, key});
  if (value.is_object())
    for (auto& [name, member] : value.items()) collect(member, &value, name, places);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], &value, std::to_string(i), places);
}

json raw_text(Random& random) {
  return raw_mark + std::to_string(random.below(raw_texts().size()));
}

json odd_number(const json& value, Random& random) {
  static const std::vector<json> odd = {0,
                                        -1,
                                        1,
                                        2,
                                        3,
                                        0.5,
                                        1e-30,
                                        1e6,
                                        999'999,
                                        1e38,
                                        -1e38,
                                        1e300,
                                        5e-324,
                                        (1u << 31) - 1,
                                        1u << 31,
                                        ~0u,
                                        1ull << 32,
                                        (1ull << 53) + 1,
                                        1ull << 62,
                                        ~0ull,
                                        std::numeric_limits<std::int64_t>::min(),
                                        100'000,
                                        5120,
                                        5123,
                                        5125,
                                        5126};
  if (random.once_in(24)) return raw_text(random);
  const double number = value.get<double>();
  switch (random.below(8)) {
    case 0:
      return value.is_number_float() ? json(0.01 * static_cast<double>(random.below(101)))
                                     : json(random.below(10));
    case 1:
      return -number;
    case 2:
      return value.is_number_integer() ? json(value.get<std::int64_t>() / 2) : json(number / 1000);
    case 3:
      return value.is_number_integer() ? json(value.get<std::uint64_t>() * 256) : json(number * 1000);
    case 4:
    case 5: {  // the neighbour of an index
      const bool up = random.once_in(2);
      if (!value.is_number_integer()) return number + (up ? 0.1 : -0.1);
      // Unsigned, as it may be the least there is.
      return static_cast<std::int64_t>(value.get<std::uint64_t>() + (up ? 1 : ~0ull));
    }
    default:
      return random.of(odd);
  }
}

json odd_string(const std::string& text, Random& random) {
  static const std::vector<std::string> known = {"",
                                                 "POSITION",
                                                 "NORMAL",
                                                 "TEXCOORD_0",
                                                 "TEXCOORD_1",
                                                 "COLOR_0",
                                                 "JOINTS_0",
                                                 "WEIGHTS_0",
                                                 "SCALAR",
                                                 "VEC2",
                                                 "VEC3",
                                                 "VEC4",
                                                 "MAT4",
                                                 "MASK",
                                                 "BLEND",
                                                 "OPAQUE",
                                                 "point",
                                                 "spot",
                                                 "mesh.bin",
                                                 "../mesh.bin",
                                                 "/dev/zero",
                                                 "picture.png",
                                                 "scene.gltf",
                                                 "scene.glb",
                                                 "sky.hdr",
                                                 "sky.exr",
                                                 ".",
                                                 "ATTRIBUTES",
                                                 "TRIANGLES",
                                                 "INDICES",
                                                 "QUATERNION",
                                                 "EXPONENTIAL",
                                                 "image/png",
                                                 "floor",
                                                 "crate",
                                                 "lamp",
                                                 "data:,",
                                                 "data:;base64,AAAA",
                                                 "KHR_mesh_quantization",
                                                 "sky",
                                                 "rest"};
  switch (random.below(10)) {
    case 0:
      return raw_text(random);
    case 1:
      return text + text;
    case 2:
      return text.substr(0, text.size() / 2);
    case 3:
      return std::string(5000, 'a');
    default:
      return random.of(known);
  }
}

json other_type(Random& random) {
  static const std::vector<json> others = {
      nullptr, true,          false,          0,         -1,        0.5, "x", "", "true",
      {},      json::array(), json::object(), {1, 2, 3}, {{"a", 1}}};
  return random.of(others);
}

std::string damage_list(json& list, Random& random) {
  if (list.empty()) {
    list.push_back(other_type(random));
    return "filled";
  }
  const auto at = random.below(list.size());
  switch (random.below(5)) {
    case 0:
      list.erase(at);
      return "an entry removed";
    case 1:
      list.insert(list.begin() + static_cast<std::ptrdiff_t>(at), json(list[at]));
      return "an entry doubled";
    case 2:
      std::swap(list[at], list[random.below(list.size())]);
      return "entries swapped";
    case 3:
      std::rotate(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(at), list.end());
      return "rotated";
    default: {
      const json entry = list[at];
      for (std::size_t i = 0, count = random.once_in(2) ? 200 : 20; i < count; ++i) list.push_back(entry);
      return "an entry many times";
    }
  }
}

std::string damage_object(json& object, Random& random) {
  if (object.empty()) {
    object["a"] = other_type(random);
    return "filled";
  }
  auto member = object.begin();
  std::advance(member, static_cast<std::ptrdiff_t>(random.below(object.size())));
  const std::string key = member.key();
  const json value = member.value();
  if (random.once_in(2)) {
    object.erase(key);
    return fmt::format("{} removed", key);
  }
  const json renamed = odd_string(key, random);
  object.erase(key);
  object[renamed.get<std::string>()] = value;
  return fmt::format("{} renamed", key);
}

std::string path_of(const std::vector<Place>& places, const Place& place) {
  std::string path = place.key;
  for (const json* parent = place.parent; parent != nullptr;) {
    const auto found = std::ranges::find(places, parent, &Place::value);
    if (found->parent != nullptr) path = fmt::format("{}/{}", found->key, path);
    parent = found->parent;
  }
  return path;
}

// Puts into an object what glTF knows and it has not, or has otherwise.
std::string graft(json& object, Random& random) {
  static const std::vector<std::pair<std::string, json>> grafts = {
      {"doubleSided", true},
      {"alphaMode", "BLEND"},
      {"alphaMode", "MASK"},
      {"alphaCutoff", 0.9},
      {"emissiveFactor", {1, 1, 1}},
      {"emissiveTexture", {{"index", 0}}},
      {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e5}}}}},
      {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}},
      {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
      {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}},
      {"extensions", {{"KHR_texture_transform", {{"scale", {1e4, 1e-9}}, {"rotation", 1e5}}}}},
      {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 0}}}}}}},
      {"baseColorFactor", {1, 1, 1, 0}},
      {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
      {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}},
      {"scale", {1, 1, 0}},
      {"scale", {-1, 1e-6, 1}},
      {"scale", {1e5, 1e5, 1e5}},
      {"scale", {1e-7, 1e-7, 1e-7}},
      {"translation", {9e5, 0, 0}},
      {"rotation", {0.6, 0, 0, 0.8}},
      {"matrix", {1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
      {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}},
      {"children", {2}},
      {"mesh", 1},
      {"skin", 0},
      {"weights", {3, -1e3}},
      {"extras", {{"movable", true}}},
      {"extras", {{"switchable", true}, {"flicker", 1}}},
      {"extras", {{"texels", 0}}},
      {"extras", {{"sky", {1e6, 0, 0}}}},
      {"mode", 0},
      {"mode", 5},
      {"mode", 6},
      {"material", 1},
      {"indices", 2},
      {"NORMAL", 0},
      {"COLOR_0", 0},
      {"TEXCOORD_0", 1},
      {"TEXCOORD_1", 1},
      {"normalized", true},
      {"byteStride", 4},
      {"byteStride", 16},
      {"byteOffset", 4},
      {"sparse",
       {{"count", 1},
        {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
        {"values", {{"bufferView", 0}}}}}};
  const auto& [key, value] = random.of(grafts);
  object[key] = value;
  return "with " + key + " " + value.dump();
}

std::string damage_json(json& root, Random& random) {
  std::vector<Place> all;
  collect(root, nullptr, "", all);
  // All parts of a file alike, and all kinds of values: most are numbers of accessors.
  std::vector<Place> places;
  if (root.empty() || random.once_in(6)) {
    places = all;
  } else {
    auto part = root.begin();
    std::advance(part, static_cast<std::ptrdiff_t>(random.below(root.size())));
    collect(part.value(), &root, part.key(), places);
  }
  const auto kind = random.below(4);
  const auto wanted = [&](const Place& place) {
    const json& value = *place.value;
    return kind == 0   ? value.is_structured()
           : kind == 1 ? value.is_string() || value.is_boolean()
                       : value.is_number();
  };
  std::vector<Place> some;
  std::ranges::copy_if(places, std::back_inserter(some), wanted);
  const Place place = some.empty() ? places[random.below(places.size())] : some[random.below(some.size())];
  json& value = *place.value;
  const std::string path = path_of(all, place), before = value.is_primitive() ? value.dump() : "";
  const auto said = [&](const std::string& what) {
    return fmt::format("{} {}: {}", path, before.substr(0, 40), what);
  };
  if (value.is_object() && random.once_in(2)) return said(graft(value, random));
  if (place.parent == nullptr) return said(damage_object(value, random));
  if (random.once_in(8)) {
    const json other = *all[random.below(all.size())].value;  // which may hold this one
    value = other;
    return said("as elsewhere");
  }
  if (random.once_in(8)) {
    value = other_type(random);
    return said("now " + value.dump());
  }
  if (random.once_in(8)) {
    if (place.parent->is_array())
      place.parent->erase(std::stoul(place.key));
    else
      place.parent->erase(place.key);
    return said("gone");
  }
  if (value.is_array()) return said(damage_list(value, random));
  if (value.is_object()) return said(damage_object(value, random));
  if (value.is_number())
    value = odd_number(value, random);
  else if (value.is_string())
    value = random.once_in(4) ? json(*all[random.below(all.size())].value)
                              : odd_string(value.get<std::string>(), random);
  else
    value = value.is_boolean() ? json(!value.get<bool>()) : other_type(random);
  return said("now " + value.dump().substr(0, 40));
}

// A chunk's length, kind or order; or what follows the chunks.
std::string damage_chunks(std::string& glb, Random& random) {
  const std::size_t second = glb.find(std::string("BIN\0", 4)) - 4;
  switch (random.below(5)) {
    case 0: {
      const std::size_t at = random.of(std::array<std::size_t, 6>{4, 8, 12, 16, second, second + 4});
      if (random.once_in(2)) {
        glb[at + random.below(4)] = random.byte();
      } else {
        glb[at] = static_cast<char>(glb[at] + (random.once_in(2) ? 4 : -4));
      }
      return fmt::format("header word at {}", at);
    }
    case 1:
      glb = glb.substr(0, 12) + glb.substr(second) + glb.substr(12, second - 12);
      return "chunks swapped";
    case 2:
      glb += glb.substr(second);
      return "a chunk behind the end";
    case 3:
      glb.resize(second);
      glb.replace(8, 4, little_endian(second, 4));
      return "without its second chunk";
    default:
      glb.resize(glb.size() - 1 - random.below(std::min<std::size_t>(glb.size() - 12, 64)));
      if (random.once_in(2)) glb.replace(8, 4, little_endian(glb.size(), 4));
      return "its end cut off";
  }
}

std::string damage_text(std::string& text, Random& random) {
  constexpr std::string_view letters = "0123456789-.eE[]{},:\"";
  if (text.empty()) return "nothing";
  const std::size_t at = random.below(text.size());
  text[at] = random.once_in(2) ? random.byte() : letters[random.below(letters.size())];
  return fmt::format("letter {} of the file", at);
}

// What a buffer's length says is what it has: only then are its bytes looked at.
void mend_length(Parts& parts) {
  const auto found = parts.gltf.find("buffers");
  if (found == parts.gltf.end() || !found->is_array() || found->empty() || !found->front().is_object()) return;
  const auto beside = parts.beside.find("mesh.bin");
  found->front()["byteLength"] = beside != parts.beside.end() ? beside->second.size() : parts.bin.size();
}

// FNV-1a: mutants of two seeds have nothing in common.
std::uint64_t seed_of(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char letter : name) hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100000001b3;
  return hash;
}

}  // namespace

Mutant mutant_of(const Seed& seed, std::uint64_t number) {
  Random random(number + seed_of(seed.name));
  Parts parts = seed.parts;
  const bool is_glb = parts.name.ends_with(".glb");
  Mutant mutant{parts.name, {}, {}};
  const auto note = [&](const std::string& what) { mutant.done += (mutant.done.empty() ? "" : "; ") + what; };
  std::size_t whole = 0;  // changes to the file as a whole come last
  bool mend = false;
  const std::size_t most = 1 + random.below(3);
  for (std::size_t changes = number == 0 ? 0 : 1 + random.below(most); changes > 0; --changes) {
    const auto kind = random.below(16);
    if (kind < 9) {
      note(damage_json(parts.gltf, random));
    } else if (kind < 15 && (!parts.beside.empty() || is_glb)) {
      const std::size_t which = random.below(parts.beside.size() + (is_glb ? 1 : 0));
      mend = mend || random.once_in(2);
      auto file = parts.beside.begin();
      std::advance(file, static_cast<std::ptrdiff_t>(which));
      const bool is_bin = file == parts.beside.end();
      std::string& bytes = is_bin ? parts.bin : file->second;
      const bool words = (is_bin || file->first == "mesh.bin") && !random.once_in(3);
      note((is_bin ? "BIN" : file->first) + ": " +
           (words ? damage_word(bytes, random) : damage_bytes(bytes, random)));
    } else {
      ++whole;
    }
  }
  if (mend) mend_length(parts);
  std::string bytes = written(parts);
  for (; whole > 0; --whole)
    if (is_glb && random.once_in(2) && bytes.size() > 100 &&
        bytes.find(std::string("BIN\0", 4)) != std::string::npos)
      note(damage_chunks(bytes, random));
    else if (random.once_in(3))
      note("file: " + damage_bytes(bytes, random));
    else
      note(damage_text(bytes, random));
  mutant.files = parts.beside;
  mutant.files[parts.name] = bytes;
  return mutant;
}

}  // namespace lichtveld::mutants
