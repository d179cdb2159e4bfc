#include "stream_client.hpp"

namespace lichtveld::stream::test {

using nlohmann::json;

namespace {

rtc::Configuration configuration(const std::string& bind_address) {
  rtc::Configuration config;
  config.bindAddress = bind_address;
  return config;
}

}  // namespace

void Client::Inbox::send(json message) {
  const std::lock_guard lock(mutex);
  if (!relay) return;
  message["id"] = id;
  relay->send_raw(message.dump());
}

void Client::Inbox::received(const json& message, rtc::PeerConnection& connection, bool through_link) {
  const std::string type = message.at("type");
  const std::lock_guard calls_lock(calls);
  if (type == "answer") {
    connection.setRemoteDescription(rtc::Description(message.at("description").get<std::string>(), "answer"));
  } else if (type == "candidate") {
    rtc::Candidate candidate(message.at("candidate").get<std::string>(), message.at("mid").get<std::string>());
    {
      const std::lock_guard lock(mutex);
      state.candidates.push_back(candidate.candidate());
      changed.notify_all();
      if (through_link) {
        candidate.resolve();
        link = std::make_unique<Link>(*candidate.port());
        candidate.changeAddress("127.0.0.1", link->port());
      }
    }
    connection.addRemoteCandidate(candidate);
  } else {
    const std::lock_guard lock(mutex);
    state.role = message;
    changed.notify_all();
  }
}

Client::Client(Relay& relay, Options options)
    : connection_(std::make_shared<rtc::PeerConnection>(configuration(options.bind_address))) {
  inbox_->relay = &relay;
  inbox_->id = id_ = relay.attach([inbox = inbox_, weak = std::weak_ptr(connection_),
                                   through_link = options.through_link](const json& message) {
    if (const auto connection = weak.lock()) inbox->received(message, *connection, through_link);
  });
  connection_->onLocalDescription(
      [inbox = inbox_, with = options.offer_with](const rtc::Description& description) {
        json message{{"type", "offer"}, {"description", std::string(description)}};
        message.update(with);
        inbox->send(message);
      });
  connection_->onLocalCandidate([inbox = inbox_, quiet = options.through_link || !options.tells_candidates](
                                    const rtc::Candidate& candidate) {
    if (!quiet)
      inbox->send({{"type", "candidate"}, {"candidate", candidate.candidate()}, {"mid", candidate.mid()}});
  });

  rtc::DataChannelInit init;
  init.protocol = options.protocol;
  init.reliability = options.reliability;
  {
    const std::lock_guard lock(inbox_->calls);
    channel_ = connection_->createDataChannel(options.label, init);
  }
  const auto change = [inbox = inbox_](auto&& what) {
    const std::lock_guard lock(inbox->mutex);
    what(*inbox);
    inbox->changed.notify_all();
  };
  channel_->onOpen([change] { change([](Inbox& inbox) { inbox.state.open = true; }); });
  channel_->onClosed([change] { change([](Inbox& inbox) { inbox.state.closed = true; }); });
  channel_->onMessage(
      [change](const rtc::binary& chunk) {
        change([&](Inbox& inbox) {
          if (inbox.state.maps.empty() && inbox.map.empty())
            inbox.state.texts_before_first_chunk = inbox.state.texts.size();
          inbox.map.insert(inbox.map.end(), chunk.begin(), chunk.end());
        });
      },
      [change](const std::string& text) {
        change([&](Inbox& inbox) {
          if (text != "PNG_TRANSFER_COMPLETE") return inbox.state.texts.push_back(text);
          inbox.state.maps.push_back(std::exchange(inbox.map, {}));
        });
      });
}

Client::~Client() {
  Relay* relay = nullptr;
  {
    const std::lock_guard lock(inbox_->mutex);
    relay = std::exchange(inbox_->relay, nullptr);
  }
  if (relay) relay->detach(id_);
}

void Client::forget_relay() {
  const std::lock_guard lock(inbox_->mutex);
  inbox_->relay = nullptr;
}

}  // namespace lichtveld::stream::test
