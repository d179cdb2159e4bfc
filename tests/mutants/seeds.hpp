// The files that mutants are made of: small ones, each sound and with one thing that exporters write.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lichtveld::mutants {

// A scene as far as mutations tell its parts apart.
struct Parts {
  std::string name;  // of the file: it ends in .glb or .gltf
  nlohmann::json gltf;
  std::string bin;                            // of a .glb
  std::map<std::string, std::string> beside;  // other files, by name
};

struct Seed {
  std::string name;  // of --seed-file
  Parts parts;
};

std::vector<Seed> seeds();

// What no JSON library writes: a string of raw_mark and a number in Parts::gltf stands for the text of that
// number.
inline constexpr const char* raw_mark = "raw:";
const std::vector<std::string>& raw_texts();

// The bytes of the file Parts::name.
std::string written(const Parts& parts);

}  // namespace lichtveld::mutants
