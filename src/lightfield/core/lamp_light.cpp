#include "core/lamp_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t packet = scene::RayPacket::size;
// Where all lamps together have more patches, those of more than a few are the sum over their samples: in
// closed form it would take too long.
constexpr std::size_t most_patches = 1024, few_patches = 16;
constexpr std::uint32_t receivers_of_a_task = 256;
// A ray ends this share of its way before its sample, which lies on a surface.
constexpr float short_of_sample = 1 - 1e-4f;

// What a sample of intensity 1 would bring to a receiver, which `to` shifts it from; nothing from below [m^-2].
float weight_of(const LampSamples& samples, std::uint32_t i, const glm::vec3& to, const TexelRecord& receiver) {
  const glm::vec3 d = glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to;
  const float squared = glm::dot(d, d), facing = glm::dot(d, receiver.normal);
  const float out = -(d.x * samples.nx[i] + d.y * samples.ny[i] + d.z * samples.nz[i]);
  const float there = samples.double_sided[i] ? std::abs(out) : std::max(out, 0.0f);
  if (squared <= 0 || facing <= 0 || glm::dot(d, receiver.face) <= 0) return 0;
  return facing * there / (squared * squared);
}

// Whether a box may lie between a place and another box: whether on the way from the one to the other, all of
// which grows with the way, some part is in it.
bool may_hide(const glm::vec3& low, const glm::vec3& high, const glm::vec3& place, const glm::vec3& lamp_low,
              const glm::vec3& lamp_high) {
  float first = 0, last = 1;                            // of the way
  const auto at_least = [&](float from, float slope) {  // from + way * slope >= 0
    if (slope > 0)
      first = std::max(first, -from / slope);
    else if (slope < 0)
      last = std::min(last, -from / slope);
    else if (from < 0)
      last = -1;
  };
  for (int axis = 0; axis < 3; ++axis) {
    at_least(high[axis] - place[axis], place[axis] - lamp_low[axis]);
    at_least(place[axis] - low[axis], lamp_high[axis] - place[axis]);
  }
  return first <= last;
}

}  // namespace

LampLight::LampLight(const scene::RayIndex& index, const scene::Scene& scene,
                     std::span<const TexelRecord> receivers)
    : index_(index),
      scene_(scene),
      receivers_(receivers),
      of_body_(scene.bodies.size()),
      irradiance_(receivers.size(), glm::vec3(0)) {
  for (std::uint32_t i = 0; i < receivers.size(); ++i) of_body_[receivers[i].body].push_back(i);
  auto shapes = find_area_lamps(scene, most_lamps);
  std::size_t patches = 0;
  for (const auto& shape : shapes) patches += shape.patches.size();
  for (auto& shape : shapes) {
    Lamp& lamp = lamps_.emplace_back();
    lamp.shape = std::move(shape);
    lamp.sampled = patches > most_patches && lamp.shape.patches.size() > few_patches;
    lamp.unshadowed.assign(receivers.size(), glm::vec3(0));
    lamp.arriving = lamp.unshadowed;
    lamp.own.assign(receivers.size(), 0);
    lamp.seen = lamp.own;
    lamp.hidden.assign(scene.bodies.size(), std::vector<std::vector<Hidden>>(scene.bodies.size()));
  }
}

void LampLight::light(const scene::Offsets& offsets, const Moves& moves) {
  offsets_ = offsets;
  std::vector<char> touched(receivers_.size(), 0);
  for (auto& lamp : lamps_) {
    const auto by_lamp = light(lamp, moves);
    for (std::size_t i = 0; i < touched.size(); ++i) touched[i] |= by_lamp[i];
  }
  for_each_index(0, static_cast<std::uint32_t>(receivers_.size()), receivers_of_a_task, [&](std::uint32_t i) {
    if (!touched[i]) return;
    irradiance_[i] = glm::vec3(0);
    for (const auto& lamp : lamps_) irradiance_[i] += lamp.arriving[i];
  });
}

std::vector<char> LampLight::light(Lamp& lamp, const Moves& moves) {
  const auto bodies = static_cast<std::uint32_t>(of_body_.size());
  const bool all = moves.has(lamp.shape.body);
  const auto moved = [&](std::uint32_t body) { return all || moves.has(body); };
  enum : char { same, hidden_anew, reset };
  std::vector<char> touched(receivers_.size(), same);
  for (std::uint32_t body = 1; body < bodies; ++body)
    for (std::uint32_t of = 0; of < bodies; ++of)
      if (moved(body) && !moved(of))
        for (const auto& [receiver, bits] : lamp.hidden[body][of]) {
          lamp.seen[receiver] = lamp.own[receiver];
          touched[receiver] = reset;
        }
  for (std::uint32_t body = 0; body < bodies; ++body) {
    if (!moved(body)) continue;
    const auto& receivers = of_body_[body];
    for_each_index(0, static_cast<std::uint32_t>(receivers.size()), receivers_of_a_task, [&](std::uint32_t i) {
      find_own(lamp, receivers[i]);
      touched[receivers[i]] = reset;
    });
  }
  for (std::uint32_t of = 0; of < bodies; ++of)
    for (std::uint32_t body = 1; body < bodies; ++body) {
      if (body == of) continue;
      const bool anew = moved(body) || moved(of);
      auto& hidden = lamp.hidden[body][of];
      if (anew) hidden = find_hidden(lamp, body, of);
      for (const auto& [receiver, bits] : hidden) {
        if (!anew && touched[receiver] != reset) continue;
        lamp.seen[receiver] &= ~bits;
        touched[receiver] = std::max<char>(touched[receiver], hidden_anew);
      }
    }
  for_each_index(0, static_cast<std::uint32_t>(receivers_.size()), receivers_of_a_task,
                 [&](std::uint32_t receiver) {
                   if (touched[receiver] != same) lamp.arriving[receiver] = arriving(lamp, receiver);
                 });
  return touched;
}

// Whether a body lies on it, so that nothing arrives.
bool LampLight::contact(std::uint32_t receiver, std::uint32_t body) const {
  const auto& record = receivers_[receiver];
  return index_.contact(body, offsets_[body], record.position + offsets_[record.body], record.face,
                        record.triangle);
}

void LampLight::find_own(Lamp& lamp, std::uint32_t receiver) const {
  const auto& record = receivers_[receiver];
  const glm::vec3 place = record.position + offsets_[record.body] - offsets_[lamp.shape.body];
  lamp.unshadowed[receiver] = glm::vec3(0);
  if (lamp.sampled) {
    for (std::uint32_t i = 0; i < samples_of_lamp; ++i)
      lamp.unshadowed[receiver] +=
          lamp.shape.samples.intensity[i] * weight_of(lamp.shape.samples, i, -place, record);
  } else {
    for (const auto& patch : lamp.shape.patches)
      lamp.unshadowed[receiver] += irradiance_of(patch, place, record.normal, record.face);
  }
  Bits bits = 0;
  if (lamp.unshadowed[receiver] != glm::vec3(0) && !contact(receiver, 0) &&
      (record.body == 0 || !contact(receiver, record.body))) {
    bits = trace(lamp, receiver, 0, all_samples);
    if (record.body != 0 && index_.may_meet_own_body(record.triangle, record.face))
      bits = trace(lamp, receiver, record.body, bits);
  }
  lamp.own[receiver] = lamp.seen[receiver] = bits;
}

// Of the samples that are wanted those that a body does not hide.
LampLight::Bits LampLight::trace(const Lamp& lamp, std::uint32_t receiver, std::uint32_t body,
                                 Bits wanted) const {
  const auto& record = receivers_[receiver];
  const auto& samples = lamp.shape.samples;
  const glm::vec3 place = record.position + offsets_[record.body] + index_.skin() / 2 * record.face;
  const glm::vec3 to = offsets_[lamp.shape.body] - place;
  Bits left = wanted;
  scene::RayPacket rays;
  for (std::uint32_t first = 0; first < samples_of_lamp; first += packet) {
    rays.lanes = static_cast<std::uint32_t>(wanted >> first & 0xffff);
    if (rays.lanes == 0) continue;
    for (std::uint32_t lane = 0; lane < packet; ++lane) {
      const std::uint32_t i = first + lane;
      rays.set(lane, place, glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to);
    }
    left &= ~(Bits{index_.occluded(body, offsets_[body], rays, short_of_sample)} << first);
  }
  return left;
}

// Samples that a body may hide, whichever receivers look at them, so that packets are full.
class LampLight::Search {
 public:
  Search(const LampLight& light, std::uint32_t body, std::vector<Hidden>& found)
      : light_(light), body_(body), found_(found) {}

  void add(std::uint32_t receiver, std::uint32_t sample, const glm::vec3& place, const glm::vec3& way) {
    rays_.set(count_, place, way);
    receiver_[count_] = receiver;
    sample_[count_] = sample;
    if (++count_ == packet) trace();
  }

  void trace() {
    if (count_ == 0) return;
    for (std::uint32_t lane = count_; lane < packet; ++lane)  // Embree reads the others, too
      rays_.set(lane, {rays_.x[0], rays_.y[0], rays_.z[0]}, {rays_.dx[0], rays_.dy[0], rays_.dz[0]});
    rays_.lanes = (1u << count_) - 1;
    const std::uint32_t hidden = light_.index_.occluded(body_, light_.offsets_[body_], rays_, short_of_sample);
    for (std::uint32_t lane = 0; lane < count_; ++lane) {
      if (!(hidden >> lane & 1)) continue;
      if (found_.empty() || found_.back().receiver != receiver_[lane]) found_.push_back({receiver_[lane], 0});
      found_.back().bits |= Bits{1} << sample_[lane];
    }
    count_ = 0;
  }

 private:
  const LampLight& light_;
  const std::uint32_t body_;
  std::vector<Hidden>& found_;
  scene::RayPacket rays_;
  std::array<std::uint32_t, packet> receiver_, sample_;
  std::uint32_t count_ = 0;
};

std::vector<LampLight::Hidden> LampLight::find_hidden(const Lamp& lamp, std::uint32_t body,
                                                      std::uint32_t of) const {
  const auto& receivers = of_body_[of];
  const auto count = static_cast<std::uint32_t>(receivers.size());
  std::vector<std::vector<Hidden>> of_task((count + receivers_of_a_task - 1) / receivers_of_a_task);
  for_each_index(0, static_cast<std::uint32_t>(of_task.size()), 1, [&](std::uint32_t task) {
    const auto first = task * receivers_of_a_task;
    Search search(*this, body, of_task[task]);
    for (auto i = first; i < std::min(first + receivers_of_a_task, count); ++i)
      find_hidden(lamp, body, receivers[i], search, of_task[task]);
    search.trace();
  });
  std::vector<Hidden> all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void LampLight::find_hidden(const Lamp& lamp, std::uint32_t body, std::uint32_t receiver, Search& search,
                            std::vector<Hidden>& found) const {
  if (lamp.own[receiver] == 0) return;
  const auto& record = receivers_[receiver];
  const auto& samples = lamp.shape.samples;
  const scene::Box& rest = scene_.bodies[body].box;
  const glm::vec3 skin(index_.skin()), low = rest.min + offsets_[body] - skin,
                                       high = rest.max + offsets_[body] + skin;
  const glm::vec3 surface = record.position + offsets_[record.body],
                  place = surface + index_.skin() / 2 * record.face;
  const glm::vec3& lamp_at = offsets_[lamp.shape.body];
  if (!may_hide(low, high, place, lamp.shape.box.min + lamp_at, lamp.shape.box.max + lamp_at)) return;
  const bool inside =
      glm::all(glm::greaterThanEqual(surface, low)) && glm::all(glm::lessThanEqual(surface, high));
  if (inside && contact(receiver, body)) {
    search.trace();  // those before it come first
    found.push_back({receiver, all_samples});
    return;
  }
  const glm::vec3 a = low - place, b = high - place, to = lamp_at - place;
  std::array<std::uint32_t, samples_of_lamp> misses;
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    const float dx = 1 / (samples.x[i] + to.x), dy = 1 / (samples.y[i] + to.y), dz = 1 / (samples.z[i] + to.z);
    const float ax = a.x * dx, bx = b.x * dx, ay = a.y * dy, by = b.y * dy, az = a.z * dz, bz = b.z * dz;
    const float first =
        std::max(std::max(std::min(ax, bx), std::min(ay, by)), std::max(std::min(az, bz), 0.0f));
    const float last = std::min(std::min(std::max(ax, bx), std::max(ay, by)), std::min(std::max(az, bz), 1.0f));
    misses[i] = first > last;
  }
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i)
    if (!misses[i] && (lamp.own[receiver] >> i & 1))
      search.add(receiver, i, place, glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to);
}

glm::vec3 LampLight::arriving(const Lamp& lamp, std::uint32_t receiver) const {
  const glm::vec3& unshadowed = lamp.unshadowed[receiver];
  const Bits seen = lamp.seen[receiver];
  if (unshadowed == glm::vec3(0) || seen == 0) return glm::vec3(0);
  return seen == all_samples ? unshadowed : unshadowed * share_seen(lamp, receiver, all_samples);
}

// Of some samples, by what each would bring.
float LampLight::share_seen(const Lamp& lamp, std::uint32_t receiver, Bits some) const {
  const auto& record = receivers_[receiver];
  const auto& samples = lamp.shape.samples;
  const Bits seen = lamp.seen[receiver] & some;
  const glm::vec3 to = offsets_[lamp.shape.body] - (record.position + offsets_[record.body]);
  float all = 0, visible = 0;
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    const float weight = (some >> i & 1) ? weight_of(samples, i, to, record) : 0.0f;
    all += weight;
    visible += (seen >> i & 1) ? weight : 0.0f;
  }
  // Where no sample shines here, a sliver of the lamp may still.
  return all > 0 ? visible / all
                 : static_cast<float>(std::popcount(seen)) / static_cast<float>(std::popcount(some));
}

glm::vec3 LampLight::half_difference(std::uint32_t receiver) const {
  constexpr Bits even = 0x5555555555555555;
  glm::vec3 sum(0);
  for (const auto& lamp : lamps_) {
    const Bits seen = lamp.seen[receiver];
    if (seen == 0 || seen == all_samples || lamp.unshadowed[receiver] == glm::vec3(0)) continue;
    sum += lamp.unshadowed[receiver] * (share_seen(lamp, receiver, even) - share_seen(lamp, receiver, ~even)) /
           2.0f;
  }
  return sum;
}

}  // namespace lichtveld::lightfield
