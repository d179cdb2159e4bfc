#include "outbox.hpp"

#include "lichtveld/stream/protocol.hpp"

namespace lichtveld::stream {

void Outbox::offer(std::shared_ptr<const Map> map) {
  if (newest_) ++counts_.skipped;
  newest_ = std::move(map);
  newest_came_ = Clock::now();
}

void Outbox::repeat_places(const std::string& otherwise) {
  due_ = shows_map_ ? shown_ : otherwise;
}

void Outbox::pump() {
  // The channel reports the moment at which its queue gets empty (a threshold of zero, its default). Checking
  // the amount after each message cannot miss it: a report that comes in between only asks for one pump too
  // many.
  while (channel_->bufferedAmount() == 0) {
    last_empty_ = Clock::now();
    if (!due_.empty()) {
      send_text(std::exchange(due_, {}));
    } else if (!due_lights_.empty()) {
      send_text(std::exchange(due_lights_, {}));
    } else if (current_) {
      send_map_part();
    } else if (newest_) {
      current_ = std::exchange(newest_, nullptr);
      current_came_ = newest_came_;
      offset_ = 0;
      due_ = shown_ = current_->places;
      shows_map_ = true;
    } else {
      return;
    }
  }
}

void Outbox::send_text(const std::string& text) {
  channel_->send(text);
  counts_.bytes += text.size();
}

void Outbox::send_map_part() {
  const auto chunk = chunk_at(current_->bytes, offset_);
  if (chunk.empty()) {
    send_text(std::string(map_complete(current_->format)));
    counts_.sending += Clock::now() - current_came_;
    current_.reset();
    ++counts_.maps;
    return;
  }
  channel_->send(reinterpret_cast<const rtc::byte*>(chunk.data()), chunk.size());
  offset_ += chunk.size();
  counts_.bytes += chunk.size();
}

}  // namespace lichtveld::stream
