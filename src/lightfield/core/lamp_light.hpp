// Light straight from lamps: what a lamp's polygons would bring without anything in between, in closed form
// (Lambert 1760; Baum et al. 1989, "Improving Radiosity Solutions through the Use of Analytically Determined
// Form-Factors"), times the share of it that is seen, by sample points (a ratio estimator: Heitz, Hill and
// McGuire 2018, "Combining Analytic Direct Illumination and Stochastic Shadows"). Which points a receiver sees
// is kept as bits: those that what stands still leaves, and those that each body hides, so that a move redoes
// that body's bits alone. Up to 16 receivers near each other look at an eighth of the points each, their
// neighbours at others, and at all only where these do not agree, or blocks beside them see the lamp otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/area_lamps.hpp"
#include "core/receiver_blocks.hpp"
#include "core/texel_records.hpp"
#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/scene/ray_index.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Neighbours share the samples of soft lamps out among `count` sets: which is each receiver's.
struct SampleSets {
  std::uint32_t count = 1;
  std::span<const std::uint32_t> of = {};  // as many as there are receivers, or none
};

class LampLight {
 public:
  // While things move, the light of lamps that move and of soft ones may be rough: receivers do with an eighth
  // of the samples each, and what they bring is soft.
  enum class Care { rough, whole };

  // More are taken together by where they lie: each costs so many bytes and a closed form a receiver.
  static constexpr std::size_t most_lamps = 64;
  static constexpr std::uint64_t bytes_a_lamp = 40;  // two irradiances, two masks

  // All of these must outlive it. `receivers`: where light arrives, on an atlas of size * size texels.
  LampLight(const scene::RayIndex& index, const scene::Scene& scene, std::span<const TexelRecord> receivers,
            std::uint32_t size, const SampleSets& sets = {});

  // Bodies are where `offsets` say, lights give `scales` times what the file says; `moves`: since the last
  // time.
  void light(const scene::Offsets& offsets, const scene::Scales& scales, const Moves& moves,
             Care care = Care::whole);
  // Whether some of it is.
  bool is_rough() const;

  // E [W m^-2] of each receiver; and of that what soft lamps bring, which differs from neighbour to neighbour
  // by their samples.
  const std::vector<glm::vec3>& irradiance() const { return irradiance_; }
  const std::vector<glm::vec3>& soft_irradiance() const { return soft_; }
  // By how much each half of the sample points differs from both: for split_half_error [W m^-2], signed. Of
  // lamps that are soft, or of the others.
  glm::vec3 half_difference(std::uint32_t receiver, bool soft) const;

 private:
  using Bits = std::uint64_t;  // a sample each
  static constexpr Bits all_samples = ~Bits{0};
  struct Hidden {
    std::uint32_t receiver;
    Bits bits;
  };
  struct Lamp {
    AreaLamp shape;
    // Of many patches: what it is from afar, and how far that is; E without anything in between is a sum over
    // these points then, instead of in closed form.
    std::vector<LampSamples> from_afar = {};
    float afar = 0;                               // from the middle of its box [m]
    std::vector<glm::vec3> unshadowed, arriving;  // E of each receiver [W m^-2]
    // Of which bodies the masks are rough, those that hide and those of their receivers; all: of every one.
    std::vector<char> rough = {};
    bool all_rough = false;
    std::vector<Bits> own, seen;  // what the standing scene and the receiver's body leave; and all
    std::vector<std::vector<std::vector<Hidden>>> hidden;  // by body, then by the receivers' body
  };

  using Block = ReceiverBlocks::Block;
  using BlockBits = std::array<Bits, ReceiverBlocks::most_receivers>;  // of each of its receivers

  // How a block's receivers see a lamp, by the samples that they have looked at.
  enum class Sight : char { none, dark, lit, mixed };  // none: nothing would arrive anyhow

  void find_covered(std::uint32_t body);
  // True for each receiver to which another light may arrive now.
  std::vector<char> light(Lamp& lamp, const Moves& moves, Care care);
  // Which samples a block's receivers look at: an eighth each; all where these disagree; all.
  enum class Look { eighth, shared, whole };
  void find_own(Lamp& lamp, std::uint32_t body, Look look) const;
  Sight find_own(Lamp& lamp, std::uint32_t body, const Block& block, Look look) const;
  std::vector<Hidden> find_hidden(const Lamp& lamp, std::uint32_t body, std::uint32_t of, Look look) const;
  void find_hidden(const Lamp& lamp, std::uint32_t body, std::uint32_t of, const Block& block, Look look,
                   std::vector<Hidden>& found) const;
  // Whether one sample alone matters.
  static bool is_point(const Lamp& lamp) {
    return lamp.shape.punctual && lamp.shape.box.min == lamp.shape.box.max;
  }
  const LampSamples& samples(const Lamp& lamp, std::uint32_t receiver) const {
    return lamp.shape.samples[lamp.shape.samples.size() > 1 ? sets_.of[receiver] : 0];
  }
  glm::vec3 unshadowed(const Lamp& lamp, std::uint32_t receiver) const;
  void weigh(const Lamp& lamp, std::uint32_t receiver, std::array<float, samples_of_lamp>& weights) const;
  Bits shining(const Lamp& lamp, std::uint32_t receiver) const;
  BlockBits hidden(const Lamp& lamp, std::uint32_t body, const Block& block, const BlockBits& looked_at,
                   const BlockBits& may_be, Look look) const;
  glm::vec3 start(std::uint32_t receiver) const;
  bool contact(std::uint32_t receiver, std::uint32_t body) const;
  glm::vec3 arriving(const Lamp& lamp, std::uint32_t receiver) const;
  glm::vec3 share_seen(const Lamp& lamp, std::uint32_t receiver, Bits some) const;

  const scene::RayIndex& index_;
  const scene::Scene& scene_;
  std::span<const TexelRecord> receivers_;
  const SampleSets sets_;
  const ReceiverBlocks blocks_;
  scene::Offsets offsets_;
  scene::Scales scales_;
  std::vector<Lamp> lamps_;
  std::vector<char> covered_;  // of receivers: what stands still or their own body lies on them
  std::vector<glm::vec3> irradiance_, soft_;
};

}  // namespace lichtveld::lightfield
