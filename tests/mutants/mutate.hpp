// Damage to a scene's files, the same for the same number.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "seeds.hpp"

namespace lichtveld::mutants {

struct Mutant {
  std::string name;                          // of the scene among its files
  std::map<std::string, std::string> files;  // bytes by name
  std::string done;                          // what was done to them, for people
};

// One to three changes: to the JSON (numbers, types, entries, names), to buffers, pictures and other files
// (bits, words, runs of bytes, lengths), or to the file as a whole (chunks, truncation). Number 0 is the seed
// itself.
Mutant mutant_of(const Seed& seed, std::uint64_t number);

}  // namespace lichtveld::mutants
