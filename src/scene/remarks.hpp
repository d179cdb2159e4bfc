// What is odd about a file and still makes a picture, for the log.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lichtveld/scene/check.hpp"

namespace lichtveld::scene {

// The same of many nodes or materials is one line with their number.
class Remarks {
 public:
  // `where` is what it is said of ("material "red""), or empty for the file; `advice` what to change;
  // `count` of what `what` itself counts.
  void add(const std::string& what, const std::string& where = {}, const std::string& advice = {},
           std::size_t count = 1);
  void append(const Remarks& others);
  // As warnings, in the order in which they came up.
  void tell(const std::string& file) const;

  const std::vector<Remark>& all() const { return remarks_; }
  std::size_t left_out() const { return left_out_; }

 private:
  std::vector<Remark> remarks_;
  std::size_t left_out_ = 0;  // beyond the kinds that are told
};

}  // namespace lichtveld::scene
