#include "lichtveld/room/room.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "inbox.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lighting.hpp"
#include "map_sender.hpp"
#include "work_log.hpp"

namespace lichtveld::room {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Maps after the last step: with the last of them light has settled, however bright the room. The others have
// so many bounces.
constexpr std::uint32_t maps_to_settle = 3, bounces_to_settle = 10;
// While nothing moves, pairs of directions that are looked at again every second, until all have been.
constexpr std::uint32_t pairs_a_check = 2;

Options checked(Options options) {
  if (!(options.rate > 0)) throw std::invalid_argument("a room makes more than 0 maps a second");
  if (!options.publish) throw std::invalid_argument("a room's maps must go somewhere");
  return options;
}

}  // namespace

// Input and update, on the thread of run(); maps are published on the sender's. Stages overlap, and hand on one
// value each: the newest places, one map.
class Room::Pipeline {
 public:
  Pipeline(const scene::Scene& scene, std::unique_ptr<lightfield::LightField> light, Options options)
      : scene_(scene),
        options_(checked(std::move(options))),
        light_(std::move(light)),
        places_(places_at_rest(scene, options_.bodies)),
        lighting_(scene, options_.scales.empty() ? scene::full(scene) : options_.scales),
        sender_(options_.publish, log_) {}

  void begin() {
    update([&](std::uint32_t) { return inbox_.stopped(); });
  }

  void run() {
    const auto shortest =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate));
    std::uint32_t waited = 0;  // maps since a step
    while (!inbox_.stopped() && !(options_.ended && options_.ended())) {
      const auto start = Clock::now();
      sender_.wait();
      const bool resting = settled() && adapted_ && !lighting_.changes();
      const auto news = inbox_.take(resting ? 1s : 0s);
      if (news) {
        log_.add("input", Clock::now() - news->came);
        if (news->places) places_ = *news->places;
        if (news->scales) lighting_.set(*news->scales);
      } else if (resting) {
        check();
        continue;
      }
      // After a step as little as the engine's settings say, so that the next step is shown soon; while nothing
      // moves what is left, but no longer than until somebody moves again.
      waited = news || lighting_.changes() ? 0 : waited + 1;
      update([&](std::uint32_t bounces) {
        if (waited == 0 || inbox_.has_news()) return true;
        return waited < maps_to_settle && bounces >= bounces_to_settle;
      });
      std::this_thread::sleep_until(start + shortest);
    }
  }

  void close() { sender_.close(); }

  Inbox& inbox() { return inbox_; }
  WorkLog& log() { return log_; }
  const scene::Scene& scene() const { return scene_; }

 private:
  bool settled() const { return light_->light() == lightfield::Light::settled; }

  // A map of the light where the bodies are; none where it has settled there. It ends early where enough() says
  // so.
  void update(const lightfield::LightField::Enough& enough) {
    light_->place(offsets_of(scene_, places_));
    light_->dim(lighting_.scales());
    if (settled() && adapted_) return;
    const auto adaptation = this->adaptation();
    lightfield::Shown shown;
    options_.around_update([&] {
      shown = log_.time("update", [&] {
        light_->step(enough);
        return light_->shown(adaptation);
      });
    });
    adapted_ = shown.adapted;
    log_.set_times(light_->times());
    sender_.send({std::move(shown), places_, light_->scales()});
  }

  // Since the last map.
  lightfield::Adaptation adaptation() {
    const auto now = Clock::now();
    const std::chrono::duration<double> passed = now - std::exchange(shown_at_, now);
    const auto kept = [&](double constant) {
      return constant > 0 ? static_cast<float>(std::exp(-passed.count() / constant)) : 0.0f;
    };
    return {.brighter = kept(options_.eye.brighter),
            .darker = kept(options_.eye.darker),
            .fixed = options_.eye.fixed};
  }

  // Between maps, while nothing moves: whether what is kept is what a fresh start would find.
  void check() {
    const auto found = light_->check_links(pairs_a_check);
    if (found.links == 0) return;
    log_.count("links_checked", found.links);
    log_.count("links_differing", found.differing);
    log_.set_times(light_->times());
    if (found.differing > 0 && !std::exchange(warned_, true))
      spdlog::warn("{} of {} links are not what a fresh build finds: a bug, please report it with the scene",
                   found.differing, found.links);
  }

  const scene::Scene& scene_;
  const Options options_;
  WorkLog log_;
  Inbox inbox_;
  std::unique_ptr<lightfield::LightField> light_;
  Places places_;
  Lighting lighting_;
  Clock::time_point shown_at_ = {};
  bool adapted_ = true;
  bool warned_ = false;
  MapSender sender_;  // last: it uses the rest
};

Room::Room(const scene::Scene& scene, std::unique_ptr<lightfield::LightField> light, Options options)
    : pipeline_(std::make_unique<Pipeline>(scene, std::move(light), std::move(options))) {}

Room::~Room() = default;

void Room::begin() {
  pipeline_->begin();
}

void Room::run() {
  pipeline_->run();
}

void Room::place(Places places) {
  pipeline_->inbox().place(std::move(places));
}

void Room::dim(scene::Scales scales) {
  pipeline_->inbox().dim(std::move(scales));
}

void Room::stop() {
  pipeline_->inbox().stop();
}

void Room::close() {
  pipeline_->close();
}

glm::vec3 Room::stepped(const Places& places, std::size_t index, Direction direction) {
  return pipeline_->log().time("place",
                               [&] { return room::stepped(pipeline_->scene(), places, index, direction); });
}

Work Room::work() const {
  return pipeline_->log().work();
}

}  // namespace lichtveld::room
