#include "remarks.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace lichtveld::scene {

std::string printable(std::string text) {
  if (text.size() > 600) text = text.substr(0, 600) + "...";
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

void Remarks::add(const std::string& what, const std::string& where) {
  auto found = std::ranges::find(remarks_, what, &Remark::what);
  if (found == remarks_.end()) found = remarks_.insert(found, {what, where, 0});
  ++found->count;
}

void Remarks::tell(const std::string& file) const {
  for (const Remark& remark : remarks_) {
    std::string line = file + ": ";
    if (!remark.first.empty()) {
      line += remark.first;
      if (remark.count > 1) line += " and " + std::to_string(remark.count - 1) + " more";
      line += ": ";
    }
    spdlog::warn("{}", printable(line + remark.what));
  }
}

}  // namespace lichtveld::scene
