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

std::string text_of(const Remark& remark) {
  if (remark.where.empty()) return remark.what;
  const std::string more = remark.count > 1 ? " and " + std::to_string(remark.count - 1) + " more" : "";
  return remark.where + more + ": " + remark.what;
}

void Remarks::add(const std::string& what, const std::string& where, const std::string& advice,
                  std::size_t count) {
  auto found = std::ranges::find(remarks_, what, &Remark::what);
  if (found == remarks_.end() && remarks_.size() == most_told) {
    ++left_out_;
    return;
  }
  if (found == remarks_.end()) found = remarks_.insert(found, {what, where, 0, advice});
  found->count += count;
}

void Remarks::append(const Remarks& others) {
  for (const auto& [what, where, count, advice] : others.remarks_) add(what, where, advice, count);
  left_out_ += others.left_out_;
}

void Remarks::tell(const std::string& file) const {
  for (const Remark& remark : remarks_) {
    spdlog::warn("{}", printable(file + ": " + text_of(remark)));
  }
  if (left_out_) spdlog::warn("{}: and {} more remarks", file, left_out_);
}

}  // namespace lichtveld::scene
