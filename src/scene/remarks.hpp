// What is odd about a file and still makes a picture, for the log.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace lichtveld::scene {

// Names in a file are anybody's text: this is without control characters, and not endless.
std::string printable(std::string text);

// The same of many nodes or materials is one line with their number.
class Remarks {
 public:
  // `where` is what it is said of ("material "red""), or empty for the file.
  void add(const std::string& what, const std::string& where = {});
  // As warnings, in the order in which they came up.
  void tell(const std::string& file) const;

 private:
  struct Remark {
    std::string what, first;  // where first
    std::size_t count = 0;
  };
  std::vector<Remark> remarks_;
  std::size_t left_out_ = 0;  // beyond the kinds that are told
};

}  // namespace lichtveld::scene
