// A room's light, whichever way it is computed: bake, bench and the live room use every engine through this.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lichtveld/gpu/times.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/lightfield/shown.hpp"
#include "lichtveld/lightfield/texel_view.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// What came of the bounces so far.
struct Solution {
  std::uint32_t bounces = 0;  // of the last step() or settle(); one over a part of the directions counts too
  // What may still be missing from E, as a share of its mean: largest change in the last bounce / (1 - max
  // albedo), which is more than all later bounces add. Infinite where some albedo is 1.
  double residual = 0;
  // What rel_rmse against the exact answer has to be expected of this many directions and pixels: from what the
  // two halves of the directions say apart. It sees what is random about them, not what they have in common.
  // After settle() alone.
  double error_estimate = 0;
  std::uint32_t texels_valid = 0;
  std::uint32_t depth_layers_max = 0;  // most layers that any PSF pixel has
  std::uint64_t overflow_pixels = 0;   // PSF pixels with more layers than Settings::layers
  std::uint64_t rays = 0, misses = 0;  // of texels that face their direction; those that hit nothing
  std::uint64_t rays_unknown = 0;      // those left out: no pixel near them lies on their side of all walls
};

// What is known of the light, where the bodies are.
enum class Light {
  unknown,  // nothing: none has been computed, or computing it has failed half-way
  moved,    // it belongs to where the bodies were, or to what lights gave
  rising,   // it belongs to where they are, and more bounces would change it
  settled,  // nothing that more bounces would change, as far as they are asked for
};

// What has changed since light was last computed. Asked here, once, and handed to whoever follows.
struct Moves {
  struct Move {
    std::uint32_t body;
    glm::vec3 from, to;  // shifts from rest [m]
  };
  bool all = true;  // nothing is known of before: every body counts as moved, and `bodies` is empty
  std::vector<Move> bodies = {};
  bool dimmed = false;  // lights have another scale

  bool has(std::uint32_t body) const;
  bool any() const { return all || !bodies.empty(); }  // has moved
};

// What is kept of before against what a fresh start finds.
struct LinkCheck {
  std::uint64_t links = 0, differing = 0;      // looked at; of these, those that see another place
  std::uint64_t misses = 0, rays_unknown = 0;  // of the links looked at, as in Solution
};

class LightField {
 public:
  // Body i is shifted by offsets[i] from its place at rest [m]; one entry a body, 0 for the first, which stands
  // still. Computes nothing.
  void place(const scene::Offsets& offsets);

  // Light i of the scene gives scales[i] times what the file says; one entry each, 0 or more. No link and no
  // shadow is looked for again. Computes nothing. Throws std::invalid_argument where light straight from lamps
  // is found by the directions (Direct::psf), which know no lights.
  void dim(const scene::Scales& scales);

  // The light of the next map of a room in which things move: as little as the engine's settings say after a
  // move, then more bounces until nothing is missing or enough(bounces so far) is true. Nothing is done, and
  // Solution::bounces is 0, where the light has settled. Should it throw, all is computed afresh the next time.
  using Enough = std::function<bool(std::uint32_t bounces)>;
  const Solution& step(const Enough& enough);

  // All bounces that are asked for, or until nothing is missing.
  const Solution& settle();

  const scene::Offsets& offsets() const { return offsets_; }
  const scene::Scales& scales() const { return scales_; }
  Light light() const { return light_; }
  const Solution& solution() const { return solution_; }

  // Of the light as it was computed last, size * size texels, row 0 on top. rgb: E [W m^-2]; a: 1 on valid
  // texels. Elsewhere a is 0, and rgb too, but where a chart that holds no texel lies and an engine lights it.
  std::vector<glm::vec4> irradiance() const { return irradiance_view().on_host(); }
  virtual TexelView irradiance_view() const = 0;
  // The same as players see it, with an exposure that follows from this one's light and that of the one before.
  virtual Shown shown(const Adaptation& adaptation = {}) = 0;

  // Looks at up to `pairs` pairs of directions of what is kept, those that have not been looked at since the
  // last move. Nothing once all have, before any light is known, and for engines that keep nothing. None is
  // expected to differ. (A pixel's centre on the border of two texels may see either.)
  LinkCheck check_links(std::uint32_t pairs);

  // From now on settle() shows what each pass puts out for the direction of that number in its first bounce,
  // and at its end: `stage` is the pass' name, with a suffix where it has several outputs. Engines without
  // passes to show ignore it.
  using StageObserver = std::function<void(const std::string& stage, const TexelView& image)>;
  virtual void observe(StageObserver, std::uint32_t /*direction*/) {}

  // What passes and the host have taken since this light field was begun to be made.
  virtual gpu::Times times() const = 0;

  virtual ~LightField() = default;
  LightField(const LightField&) = delete;
  LightField& operator=(const LightField&) = delete;

 protected:
  LightField(const scene::Scene& scene, Direct direct)
      : offsets_(scene.bodies.size(), glm::vec3(0)),
        scales_(scene.lights.size(), glm::vec3(1)),
        direct_(direct) {}

  // Computes light where offsets() are. `before`: what is known of it; `moves`: since then, none but after
  // Light::unknown (all) and Light::moved. True if it has settled.
  virtual bool compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) = 0;
  // Solution::error_estimate of what was computed last.
  virtual double error_estimate() const = 0;
  virtual LinkCheck check_kept_links(std::uint32_t /*pairs*/) { return {}; }

 private:
  Moves moves_since() const;
  void advance(const Enough& enough);

  scene::Offsets offsets_;
  scene::Scales scales_;
  scene::Offsets known_;  // where the bodies were when light was last computed
  scene::Scales known_scales_;
  const Direct direct_;
  Light light_ = Light::unknown;
  Solution solution_;
};

}  // namespace lichtveld::lightfield
