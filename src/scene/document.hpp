// The JSON of a glTF file, without what only its author knows: extras may be of any size, and of their numbers
// a parsed document takes ten times the text.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace lichtveld::scene {

// A document whose extras are kept as text, for a file that is written anew.
class Document {
 public:
  explicit Document(std::span<const std::uint8_t> text);

  // Each of the extras is a string here that stands for its text.
  nlohmann::json root;

  // What the extras of an object in `root` say, to be changed and put in their place; an empty object where there
  // are none.
  nlohmann::json extras_of(const nlohmann::json& owner) const;

  // The document as text, extras as they were. What is no UTF-8 is replaced.
  std::string text() const;

 private:
  std::string mark_;                 // begins these strings: a hash of the file, which it cannot hold
  std::vector<std::string> extras_;  // by the number that follows it
};

// The document for reading: of extras only what a scene is read by (movable, sky, ..). `left_out` says whether
// there was anything else. Throws SceneError for what is no JSON object, nests too deeply or is too large.
nlohmann::json read_document(std::span<const std::uint8_t> text, bool& left_out);

}  // namespace lichtveld::scene
