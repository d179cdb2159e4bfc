#include "remarks.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace lichtveld::scene {
namespace {
constexpr std::size_t most_told = 50;  // kinds: what a file names may be of as many kinds as it likes
}

std::string printable(std::string text) {
  if (text.size() > 600) text = text.substr(0, 600) + "...";
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

void Remarks::add(const std::string& what, const std::string& where) {
  auto found = std::ranges::find(remarks_, what, &Remark::what);
  if (found == remarks_.end() && remarks_.size() == most_told) {
    ++left_out_;
    return;
  }
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
  if (left_out_) spdlog::warn("{}: and {} more remarks", file, left_out_);
}

}  // namespace lichtveld::scene
