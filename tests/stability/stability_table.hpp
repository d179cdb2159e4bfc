// The suite's table: printed at the end of a run, and written as Markdown.
#pragma once

#include <filesystem>

#include "stability_case.hpp"

namespace lichtveld::stability {

struct Row {
  std::string name;  // of the case
  Figure figure;
  std::array<double, 4> values, errors;  // by Method
};

class Table {
 public:
  void add(const Case& of, std::vector<Row> rows);
  bool empty() const { return cases_.empty(); }
  void print() const;
  void write_markdown(const std::filesystem::path& file) const;

 private:
  struct Entry {
    Case of;
    std::vector<Row> rows;
  };
  std::vector<Entry> cases_;
};

}  // namespace lichtveld::stability
