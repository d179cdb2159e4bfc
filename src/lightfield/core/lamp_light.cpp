#include "core/lamp_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/scene/ray_queue.hpp"
#include "lichtveld/scene/slabs.hpp"

namespace lichtveld::lightfield {

namespace {

using Samples = std::array<float, samples_of_lamp>;
// Every eighth of the samples.
constexpr std::uint64_t eighth = 0x0101010101010101;
// Fewer rays than this do not tell that all others of a block are the same.
constexpr int rays_that_decide = 64;
// Lamps of more than a few patches are points in their middles from so far away [their boxes' diagonals]; where
// all lamps together have more than that many patches, from everywhere: in closed form it would take too long.
constexpr std::size_t few_patches = 16, most_patches = 4096;
constexpr float afar = 1.5f;
constexpr std::uint32_t receivers_of_a_task = 256, blocks_of_a_task = 16;
// A ray ends this share of its way before its sample, which lies on a surface.
constexpr float short_of_sample = 1 - 1e-4f;

// What each sample would bring to a receiver with intensity 1, which `to` shifts it from; nothing from below
// [m^-2]. Written so that compilers do several at once.
void weigh(const LampSamples& samples, const glm::vec3& to, const TexelRecord& receiver, Samples& weights) {
  const glm::vec3 normal = receiver.normal, face = receiver.face;
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    const float x = samples.x[i] + to.x, y = samples.y[i] + to.y, z = samples.z[i] + to.z;
    const float squared = x * x + y * y + z * z, facing = x * normal.x + y * normal.y + z * normal.z,
                above = x * face.x + y * face.y + z * face.z;
    const float out = -(x * samples.nx[i] + y * samples.ny[i] + z * samples.nz[i]);
    const float there = std::max(out, out * samples.back[i]);
    const float weight = facing * there / (squared * squared);
    weights[i] = std::min(std::min(squared, facing), std::min(above, there)) > 0 ? weight : 0.0f;
  }
}

// Of all samples, where of each eight the first has been looked at: what is hidden of those. Eight whose first
// brings no light are as most others are.
std::uint64_t as_looked(std::uint64_t hidden, std::uint64_t looked_at) {
  hidden &= eighth, looked_at &= eighth;
  if (2 * std::popcount(hidden) > std::popcount(looked_at)) hidden |= eighth & ~looked_at;
  return hidden * 0xff;
}

scene::Box shifted(const scene::Box& box, const glm::vec3& by, float grown) {
  return {box.min + by - grown, box.max + by + grown};
}

// Whether all of a box is above a place.
bool is_above(const scene::Box& box, const glm::vec3& up, const glm::vec3& place) {
  const glm::vec3 middle = (box.min + box.max) / 2.0f - place, half = (box.max - box.min) / 2.0f;
  return glm::dot(up, middle) > glm::dot(glm::abs(up), half);
}

// Whether a box may lie between two others: whether on the way from the one to the other some part of what
// the one becomes, growing or shrinking to the other, is in it.
bool may_hide(const scene::Box& box, const scene::Box& places, const scene::Box& lamp) {
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
    at_least(box.max[axis] - places.min[axis], places.min[axis] - lamp.min[axis]);
    at_least(places.max[axis] - box.min[axis], lamp.max[axis] - places.max[axis]);
  }
  return first <= last;
}

}  // namespace

LampLight::LampLight(const scene::RayIndex& index, const scene::Scene& scene,
                     std::span<const TexelRecord> receivers, std::uint32_t size, const SampleSets& sets)
    : index_(index),
      scene_(scene),
      receivers_(receivers),
      sets_(sets),
      blocks_(receivers, static_cast<std::uint32_t>(scene.bodies.size()), size),
      covered_(receivers.size(), 0),
      irradiance_(receivers.size(), glm::vec3(0)),
      soft_(receivers.size(), glm::vec3(0)) {
  auto shapes = find_area_lamps(scene, most_lamps, sets.count);
  std::size_t patches = 0;
  for (const auto& shape : shapes) patches += shape.patches.size();
  for (auto& shape : shapes) {
    Lamp& lamp = lamps_.emplace_back();
    lamp.shape = std::move(shape);
    if (lamp.shape.patches.size() > few_patches) {
      lamp.from_afar = middles_of(lamp.shape.patches);
      lamp.afar = patches > most_patches ? 0 : afar * glm::distance(lamp.shape.box.min, lamp.shape.box.max);
    }
    lamp.unshadowed.assign(receivers.size(), glm::vec3(0));
    lamp.arriving = lamp.unshadowed;
    lamp.own.assign(receivers.size(), 0);
    lamp.seen = lamp.own;
    lamp.rough.assign(scene.bodies.size(), 0);
    lamp.hidden.assign(scene.bodies.size(), std::vector<std::vector<Hidden>>(scene.bodies.size()));
  }
}

bool LampLight::is_rough() const {
  return std::ranges::any_of(lamps_, [](const Lamp& lamp) {
    return lamp.all_rough || std::ranges::find(lamp.rough, 1) != lamp.rough.end();
  });
}

void LampLight::light(const scene::Offsets& offsets, const scene::Scales& scales, const Moves& moves,
                      Care care) {
  offsets_ = offsets;
  scales_ = scales;
  std::vector<char> touched(receivers_.size(), moves.dimmed);
  for (std::uint32_t body = 0; body < scene_.bodies.size(); ++body)
    if (moves.has(body)) find_covered(body);
  if (moves.any() || (care == Care::whole && is_rough())) {
    progress::Work work("light straight from lamps", lamps_.size());
    for (auto& lamp : lamps_) {
      const auto by_lamp = light(lamp, moves, care);
      for (std::size_t i = 0; i < touched.size(); ++i) touched[i] |= by_lamp[i];
      work.done();
    }
  }
  for_each_index(0, static_cast<std::uint32_t>(receivers_.size()), receivers_of_a_task, [&](std::uint32_t i) {
    if (!touched[i]) return;
    irradiance_[i] = soft_[i] = glm::vec3(0);
    for (const auto& lamp : lamps_) {
      const glm::vec3 light = scales_[lamp.shape.light] * lamp.arriving[i];
      irradiance_[i] += light;
      if (lamp.shape.soft || lamp.all_rough) soft_[i] += light;
    }
  });
}

std::vector<char> LampLight::light(Lamp& lamp, const Moves& moves, Care care) {
  const auto bodies = static_cast<std::uint32_t>(scene_.bodies.size());
  const bool whole = care == Care::whole, own_move = moves.has(lamp.shape.body);
  const bool all = own_move || (whole && lamp.all_rough);
  const auto moved = [&](std::uint32_t body) { return all || moves.has(body) || (whole && lamp.rough[body]); };
  const Look look = !whole && (lamp.shape.soft || own_move) ? Look::eighth : Look::shared;
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
    find_own(lamp, body, look);
    const auto& blocks = blocks_.of_body(body);
    if (blocks.size() == 0) continue;
    for (const auto receiver : blocks_.receivers(blocks)) touched[receiver] = reset;
  }
  for (std::uint32_t of = 0; of < bodies; ++of)
    for (std::uint32_t body = 1; body < bodies; ++body) {
      if (body == of) continue;
      const bool anew = moved(body) || moved(of);
      auto& hidden = lamp.hidden[body][of];
      if (anew) hidden = find_hidden(lamp, body, of, look);
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
  if (look == Look::eighth) {
    lamp.all_rough |= all;
    for (std::uint32_t body = 0; body < bodies; ++body) lamp.rough[body] |= moved(body);
  } else if (whole) {
    lamp.all_rough = false;
    std::ranges::fill(lamp.rough, 0);
  }
  return touched;
}

// Of the receivers of a body.
void LampLight::find_covered(std::uint32_t body) {
  const auto& blocks = blocks_.of_body(body);
  for_each_index(blocks.first, blocks.end, blocks_of_a_task, [&](std::uint32_t i) {
    for (const auto receiver : blocks_.receivers({i, i + 1})) {
      const auto& record = receivers_[receiver];
      const bool meets = body != 0 && index_.may_meet_own_body(record.triangle, record.face);
      covered_[receiver] = contact(receiver, 0) || (meets && contact(receiver, body));
    }
  });
}

// Whether a body lies on it, so that nothing arrives.
bool LampLight::contact(std::uint32_t receiver, std::uint32_t body) const {
  const auto& record = receivers_[receiver];
  return index_.contact(body, offsets_[body], record.position + offsets_[record.body], record.face,
                        record.triangle);
}

// Where its rays start [m].
glm::vec3 LampLight::start(std::uint32_t receiver) const {
  const auto& record = receivers_[receiver];
  return record.position + offsets_[record.body] + index_.skin() / 2 * record.face;
}

// The samples that would bring light to a receiver to which any comes, so that it matters whether they are
// seen.
LampLight::Bits LampLight::shining(const Lamp& lamp, std::uint32_t receiver) const {
  const auto& record = receivers_[receiver];
  const scene::Box box = shifted(lamp.shape.box, offsets_[lamp.shape.body], 0);
  if (lamp.shape.patches.size() == 1 && is_above(box, record.face, record.position + offsets_[record.body]) &&
      is_above(box, record.normal, record.position + offsets_[record.body]))
    return all_samples;
  Samples weights;
  weigh(lamp, receiver, weights);
  Bits bits = 0;
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) bits |= Bits{weights[i] > 0} << i;
  // A sliver of the lamp between samples that are below the horizon: all of them stand for it.
  return bits == 0 ? all_samples : bits;
}

// E without anything in between.
glm::vec3 LampLight::unshadowed(const Lamp& lamp, std::uint32_t receiver) const {
  const auto& record = receivers_[receiver];
  const glm::vec3 at = record.position + offsets_[record.body], &lamp_at = offsets_[lamp.shape.body];
  if (lamp.shape.punctual)
    return scene::irradiance_of(*lamp.shape.punctual, lamp_at, at, record.normal, record.face);
  glm::vec3 sum(0);
  Samples weights;
  const auto& intensity = samples(lamp, receiver).intensity;
  const glm::vec3 middle = (lamp.shape.box.min + lamp.shape.box.max) / 2.0f + lamp_at;
  if (!lamp.from_afar.empty() && glm::distance(at, middle) >= lamp.afar) {
    for (const auto& points : lamp.from_afar) {
      lightfield::weigh(points, lamp_at - at, record, weights);
      for (std::uint32_t i = 0; i < samples_of_lamp; ++i) sum += points.intensity[i] * weights[i];
    }
  } else {
    for (const auto& patch : lamp.shape.patches)
      sum += irradiance_of(patch, at - lamp_at, record.normal, record.face);
  }
  if (!lamp.shape.coloured || sum == glm::vec3(0)) return sum;
  weigh(lamp, receiver, weights);
  glm::vec3 colour(0), even(0);
  float all = 0;
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    colour += weights[i] * intensity[i];
    even += intensity[i];
    all += weights[i];
  }
  return sum * (all > 0 ? colour / all : even / static_cast<float>(samples_of_lamp));
}

// What each sample counts for there, beside its intensity.
void LampLight::weigh(const Lamp& lamp, std::uint32_t receiver, Samples& weights) const {
  const auto& record = receivers_[receiver];
  const auto& samples = this->samples(lamp, receiver);
  const glm::vec3 to = offsets_[lamp.shape.body] - (record.position + offsets_[record.body]);
  if (!lamp.shape.punctual) return lightfield::weigh(samples, to, record, weights);
  weights.fill(0);
  for (std::uint32_t i = 0; i < (is_point(lamp) ? 1 : samples_of_lamp); ++i) {
    const glm::vec3 way = glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to;
    const float squared = glm::dot(way, way);
    if (squared <= 0 || glm::dot(way, record.face) <= 0) continue;
    weights[i] = std::max(glm::dot(way, record.normal), 0.0f) / (squared * std::sqrt(squared));
  }
}

// Blocks that see the lamp otherwise than those around them look at all samples: the rim of a small part that
// is seen, or hidden, may lie between those that they have looked at.
void LampLight::find_own(Lamp& lamp, std::uint32_t body, Look look) const {
  const auto& blocks = blocks_.of_body(body);
  std::vector<Sight> sights(blocks.size());
  for_each_index(blocks.first, blocks.end, blocks_of_a_task,
                 [&](std::uint32_t i) { sights[i - blocks.first] = find_own(lamp, body, blocks_[i], look); });
  if (look == Look::eighth) return;
  const auto differs = [&](std::uint32_t block) {
    const Sight own = sights[block - blocks.first];
    return (own == Sight::dark || own == Sight::lit) &&
           std::ranges::any_of(blocks_.beside(block), [&](std::uint32_t other) {
             const Sight sight = sights[other - blocks.first];
             return sight != Sight::none && sight != own;
           });
  };
  for_each_index(blocks.first, blocks.end, blocks_of_a_task, [&](std::uint32_t i) {
    if (differs(i)) find_own(lamp, body, blocks_[i], Look::whole);
  });
}

LampLight::Sight LampLight::find_own(Lamp& lamp, std::uint32_t body, const Block& block, Look look) const {
  BlockBits looked_at{};
  bool meets_body = false;
  for (std::uint32_t i = 0; i < block.size(); ++i) {
    const std::uint32_t receiver = blocks_.receiver(block, i);
    const auto& record = receivers_[receiver];
    const glm::vec3 unshadowed = lamp.unshadowed[receiver] = this->unshadowed(lamp, receiver);
    const bool meets = body != 0 && index_.may_meet_own_body(record.triangle, record.face);
    if (unshadowed == glm::vec3(0) || covered_[receiver]) continue;
    looked_at[i] = shining(lamp, receiver);
    meets_body |= meets;
  }
  BlockBits left = looked_at;
  const auto leave_out_hidden = [&](std::uint32_t by) {
    const auto out_of_sight = hidden(lamp, by, block, left, left, look);
    for (std::uint32_t i = 0; i < block.size(); ++i) left[i] &= ~out_of_sight[i];
  };
  leave_out_hidden(0);
  if (meets_body) leave_out_hidden(body);
  for (std::uint32_t i = 0; i < block.size(); ++i) {
    const std::uint32_t receiver = blocks_.receiver(block, i);
    // Whether a sample that brings no light is seen does not matter.
    lamp.own[receiver] = lamp.seen[receiver] = looked_at[i] == 0 ? 0 : left[i] | ~looked_at[i];
  }
  const auto any = [](const BlockBits& bits) {
    return std::ranges::any_of(bits, [](Bits one) { return one != 0; });
  };
  return !any(looked_at)     ? Sight::none
         : left == looked_at ? Sight::lit
         : any(left)         ? Sight::mixed
                             : Sight::dark;
}

// Of the samples that each receiver of a block looks at those that a body hides, which `may_be` are all of,
// too.
LampLight::BlockBits LampLight::hidden(const Lamp& lamp, std::uint32_t body, const Block& block,
                                       const BlockBits& looked_at, const BlockBits& may_be, Look look) const {
  struct Of {
    std::uint32_t in_block, sample;
  };
  const glm::vec3& lamp_at = offsets_[lamp.shape.body];
  BlockBits found{};
  scene::RayQueue<Of> queue;
  const auto trace = [&](const scene::RayPacket& rays, std::span<const Of> of) {
    const std::uint32_t occluded = index_.occluded(body, offsets_[body], rays, short_of_sample);
    for (std::size_t lane = 0; lane < of.size(); ++lane)
      found[of[lane].in_block] |= Bits{occluded >> lane & 1} << of[lane].sample;
  };
  const auto look_at = [&](std::uint32_t i, Bits some) {
    if (some == 0) return;
    const std::uint32_t receiver = blocks_.receiver(block, i);
    const auto& samples = this->samples(lamp, receiver);
    const glm::vec3 place = start(receiver);
    for (; some != 0; some &= some - 1) {
      const auto sample = static_cast<std::uint32_t>(std::countr_zero(some));
      const glm::vec3 there = glm::vec3(samples.x[sample], samples.y[sample], samples.z[sample]) + lamp_at;
      queue.add(place, there - place, {i, sample}, trace);
    }
  };
  int looked = 0, hid = 0;
  for (std::uint32_t i = 0; i < block.size(); ++i) {
    look_at(i, may_be[i] & (eighth << i % 8));
    looked += std::popcount(looked_at[i] & (eighth << i % 8));
  }
  queue.flush(trace);
  for (const Bits bits : found) hid += std::popcount(bits);
  const bool decided = look != Look::whole && looked >= rays_that_decide;
  if (decided && hid == 0) return found;
  if (decided && hid == looked) return may_be;
  if (look == Look::eighth) {
    for (std::uint32_t i = 0; i < block.size(); ++i)
      found[i] = as_looked(found[i] >> i % 8, looked_at[i] >> i % 8) & may_be[i];
    return found;
  }
  for (std::uint32_t i = 0; i < block.size(); ++i) look_at(i, may_be[i] & ~(eighth << i % 8));
  queue.flush(trace);
  return found;
}

std::vector<LampLight::Hidden> LampLight::find_hidden(const Lamp& lamp, std::uint32_t body, std::uint32_t of,
                                                      Look look) const {
  const auto& blocks = blocks_.of_body(of);
  std::vector<std::vector<Hidden>> of_task((blocks.size() + blocks_of_a_task - 1) / blocks_of_a_task);
  for_each_index(0, static_cast<std::uint32_t>(of_task.size()), 1, [&](std::uint32_t task) {
    const auto first = blocks.first + task * blocks_of_a_task;
    for (auto i = first; i < std::min(first + blocks_of_a_task, blocks.end); ++i)
      find_hidden(lamp, body, of, blocks_[i], look, of_task[task]);
  });
  std::vector<Hidden> all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void LampLight::find_hidden(const Lamp& lamp, std::uint32_t body, std::uint32_t of, const Block& block,
                            Look look, std::vector<Hidden>& found) const {
  const float skin = index_.skin();
  const glm::vec3& lamp_at = offsets_[lamp.shape.body];
  const scene::Box box = shifted(scene_.bodies[body].box, offsets_[body], skin),
                   lamp_box = shifted(lamp.shape.box, lamp_at, 0);
  if (!may_hide(box, shifted(block.box, offsets_[of], skin), lamp_box)) return;
  BlockBits looked_at{}, may_be{};
  for (std::uint32_t i = 0; i < block.size(); ++i) {
    const std::uint32_t receiver = blocks_.receiver(block, i);
    if (lamp.own[receiver] == 0) continue;
    const glm::vec3 place = start(receiver);
    if (!may_hide(box, {place, place}, lamp_box)) continue;
    const bool inside = glm::all(glm::greaterThanEqual(place, box.min - skin)) &&
                        glm::all(glm::lessThanEqual(place, box.max + skin));
    if (inside && contact(receiver, body)) {
      found.push_back({receiver, all_samples});
      continue;
    }
    const glm::vec3 to = lamp_at - place;
    const auto& samples = this->samples(lamp, receiver);
    Samples x, y, z, entries;
    for (std::uint32_t k = 0; k < samples_of_lamp; ++k) {
      x[k] = 1 / (samples.x[k] + to.x);
      y[k] = 1 / (samples.y[k] + to.y);
      z[k] = 1 / (samples.z[k] + to.z);
    }
    const scene::Coordinates places{&place.x, &place.y, &place.z};
    scene::enter<0, 1>(box, samples_of_lamp, places, places, {x.data(), y.data(), z.data()}, entries.data());
    Bits crossing = 0;
    for (std::uint32_t k = 0; k < samples_of_lamp; ++k) crossing |= Bits{entries[k] <= 1} << k;
    if (crossing == 0) continue;
    looked_at[i] = lamp.own[receiver] & shining(lamp, receiver);
    may_be[i] = looked_at[i] & crossing;
  }
  const auto bits = hidden(lamp, body, block, looked_at, may_be, look);
  for (std::uint32_t i = 0; i < block.size(); ++i)
    if (bits[i] != 0) found.push_back({blocks_.receiver(block, i), bits[i]});
}

glm::vec3 LampLight::arriving(const Lamp& lamp, std::uint32_t receiver) const {
  const glm::vec3& unshadowed = lamp.unshadowed[receiver];
  const Bits seen = lamp.seen[receiver];
  if (unshadowed == glm::vec3(0) || seen == 0) return glm::vec3(0);
  return seen == all_samples ? unshadowed : unshadowed * share_seen(lamp, receiver, all_samples);
}

// Of some samples, by what each would bring.
glm::vec3 LampLight::share_seen(const Lamp& lamp, std::uint32_t receiver, Bits some) const {
  const Bits seen = lamp.seen[receiver] & some;
  Samples weights;
  weigh(lamp, receiver, weights);
  float all = 0, visible = 0;
  glm::vec3 all_colours(0), visible_colours(0);
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    all += (some >> i & 1) ? weights[i] : 0.0f;
    visible += (seen >> i & 1) ? weights[i] : 0.0f;
  }
  // Where no sample shines here, a sliver of the lamp may still.
  const float share = all > 0
                          ? visible / all
                          : static_cast<float>(std::popcount(seen)) / static_cast<float>(std::popcount(some));
  if (!lamp.shape.coloured || !(all > 0)) return glm::vec3(share);
  for (Bits left = some; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    const glm::vec3 light = weights[i] * samples(lamp, receiver).intensity[i];
    all_colours += light;
    visible_colours += (seen >> i & 1) ? light : glm::vec3(0);
  }
  return visible_colours / glm::max(all_colours, glm::vec3(std::numeric_limits<float>::min()));
}

glm::vec3 LampLight::half_difference(std::uint32_t receiver, bool soft) const {
  constexpr Bits even = 0x5555555555555555;
  glm::vec3 sum(0);
  for (const auto& lamp : lamps_) {
    const Bits seen = lamp.seen[receiver];
    if (lamp.shape.soft != soft || seen == 0 || seen == all_samples || is_point(lamp) ||
        lamp.unshadowed[receiver] == glm::vec3(0))
      continue;
    sum += scales_[lamp.shape.light] * lamp.unshadowed[receiver] *
           (share_seen(lamp, receiver, even) - share_seen(lamp, receiver, ~even)) / 2.0f;
  }
  return sum;
}

}  // namespace lichtveld::lightfield
