#include "document.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string_view>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

constexpr std::size_t max_nesting = 64;  // JSON levels; tinygltf recurses into values, exporters need < 20
constexpr std::size_t max_json_bytes = 64u << 20;  // a parsed document takes several times its text

// What a scene is read by, and how many numbers of a list are looked at.
constexpr std::array<std::string_view, 8> read_of_extras = {"angle",    "flicker", "movable",    "radius",
                                                            "schedule", "sky",     "switchable", "texels"};
constexpr std::size_t longest_list = 16;

// Goes through a text and tells how far the parser has come, which looks no further than the bracket at which
// it says that something begins or ends.
class Counted {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Counted(const std::uint8_t* at, std::size_t* count) : at_(at), count_(count) {}
  reference operator*() const { return *reinterpret_cast<const char*>(at_); }
  Counted& operator++() {
    ++at_, ++*count_;
    return *this;
  }
  Counted operator++(int) {
    const Counted before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Counted& other) const { return at_ == other.at_; }
  bool operator!=(const Counted& other) const { return at_ != other.at_; }

 private:
  const std::uint8_t* at_;
  std::size_t* count_;
};

// Builds a document from what the parser meets; what `extras` hold is left out where it is of no use, or kept
// as text. Takes time in proportion to the text.
class Builder : public nlohmann::json_sax<json> {
 public:
  // `count`: how far the text is read. `texts`: where extras begin and end in it, or null to read them.
  Builder(json& root, const std::size_t& count, const std::string& mark,
          std::vector<std::pair<std::size_t, std::size_t>>* texts)
      : root_(root), count_(count), mark_(mark), texts_(texts) {}

  bool left_out() const { return left_out_; }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override { return put(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return begin(json::value_t::object); }
  bool start_array(std::size_t) override { return begin(json::value_t::array); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }

  bool key(string_t& name) override {
    if (skipped_ > 0) return true;
    Level& level = levels_.back();
    level.is_extras = name == "extras";
    level.left_out = level.of_extras && std::ranges::find(read_of_extras, name) == read_of_extras.end();
    if (level.left_out)
      left_out_ = true;
    else
      level.next = &(*level.value)[std::move(name)];
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    throw SceneError(std::string("not a glTF file (neither a .glb nor JSON): ") + error.what());
  }

 private:
  struct Level {
    json* value;
    json* next = nullptr;    // of an object: where the member of the last key goes
    bool of_extras = false;  // it is the value of a key "extras", or in one
    bool is_extras = false;  // the last key was that
    bool left_out = false;   // the last key is of no use
  };

  // Where the next value goes; null where it is left out.
  json* place() {
    if (levels_.empty()) return &root_;
    Level& level = levels_.back();
    if (level.value->is_object()) return level.left_out ? nullptr : level.next;
    if (level.of_extras && level.value->size() == longest_list) {
      left_out_ = true;
      return nullptr;
    }
    return &level.value->emplace_back();
  }

  template <typename Value>
  bool put(Value&& value) {
    if (skipped_ == 0)
      if (json* at = place()) *at = std::forward<Value>(value);
    return true;
  }

  // Of what extras hold: extras that are a list, and lists and objects in a list.
  bool says_nothing(json::value_t type) const {
    return levels_.back().of_extras ? levels_.back().value->is_array() : type == json::value_t::array;
  }

  bool begin(json::value_t type) {
    if (++depth_ > max_nesting) throw SceneError("its JSON nests deeper than 64 levels");
    const bool of_extras =
        !levels_.empty() && skipped_ == 0 && (levels_.back().of_extras || levels_.back().is_extras);
    json* at = skipped_ > 0 ? nullptr : place();
    if (of_extras && texts_) {
      texts_->emplace_back(count_ - 1, 0);
      *at = mark_ + std::to_string(texts_->size() - 1);
      at = nullptr;
    } else if (of_extras && at && says_nothing(type)) {
      left_out_ = true;
      at = nullptr;
    }
    if (!at) {
      ++skipped_;
      return true;
    }
    *at = json(type);
    levels_.push_back({.value = at, .of_extras = of_extras});
    return true;
  }

  bool end() {
    --depth_;
    if (skipped_ == 0) {
      levels_.pop_back();
    } else if (--skipped_ == 0 && texts_ && !texts_->empty() && texts_->back().second == 0) {
      texts_->back().second = count_;
    }
    return true;
  }

  json& root_;
  const std::size_t& count_;
  const std::string& mark_;
  std::vector<std::pair<std::size_t, std::size_t>>* texts_;
  std::vector<Level> levels_;
  std::size_t depth_ = 0, skipped_ = 0;  // levels, and how many of them nothing is built of
  bool left_out_ = false;
};

bool parse(std::span<const std::uint8_t> text, json& root, const std::string& mark,
           std::vector<std::pair<std::size_t, std::size_t>>* texts) {
  if (text.size() > max_json_bytes) throw SceneError("its JSON is larger than 64 MiB");
  std::size_t count = 0;
  Builder builder(root, count, mark, texts);
  json::sax_parse(Counted(text.data(), &count), Counted(text.data() + text.size(), &count), &builder);
  if (!root.is_object()) throw SceneError("its JSON is no object: not a glTF file");
  return builder.left_out();
}

std::string_view view_of(std::span<const std::uint8_t> text) {
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

}  // namespace

Document::Document(std::span<const std::uint8_t> text)
    : mark_(fmt::format("extras-{:016x}-", std::hash<std::string_view>()(view_of(text)))) {
  std::vector<std::pair<std::size_t, std::size_t>> places;
  parse(text, root, mark_, &places);
  for (const auto& [begin, end] : places) extras_.emplace_back(view_of(text).substr(begin, end - begin));
}

json Document::extras_of(const json& owner) const {
  const auto found = owner.find("extras");
  if (found == owner.end()) return json::object();
  const auto* kept = found->get_ptr<const std::string*>();
  if (!kept || !kept->starts_with(mark_)) return *found;
  return json::parse(extras_.at(std::stoul(kept->substr(mark_.size()))));
}

std::string Document::text() const {
  const std::string dumped = root.dump(-1, ' ', false, json::error_handler_t::replace), quoted = '"' + mark_;
  std::size_t size = dumped.size();
  for (const auto& extras : extras_) size += extras.size();
  std::string result;
  result.reserve(size);
  std::size_t from = 0;
  for (std::size_t at = 0; (at = dumped.find(quoted, from)) != std::string::npos;) {
    const std::size_t number_at = at + quoted.size(), end = dumped.find('"', number_at);
    std::size_t number = 0;
    std::from_chars(dumped.data() + number_at, dumped.data() + end, number);
    result.append(dumped, from, at - from).append(extras_.at(number));
    from = end + 1;
  }
  return result.append(dumped, from);
}

json read_document(std::span<const std::uint8_t> text, bool& left_out) {
  json root;
  left_out = parse(text, root, {}, nullptr);
  return root;
}

}  // namespace lichtveld::scene
