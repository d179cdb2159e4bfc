#include "lichtveld/lightfield/light_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/convergence.hpp"

namespace lichtveld::lightfield {

bool Moves::has(std::uint32_t body) const {
  return all || std::ranges::any_of(bodies, [&](const Move& move) { return move.body == body; });
}

void LightField::place(const scene::Offsets& offsets) {
  if (offsets.size() != offsets_.size())
    throw std::invalid_argument(std::to_string(offsets.size()) + " bodies are placed, and the scene has " +
                                std::to_string(offsets_.size()));
  if (offsets == offsets_) return;
  offsets_ = offsets;
  if (light_ != Light::unknown) light_ = Light::moved;
}

void LightField::dim(const scene::Scales& scales) {
  if (scales.size() != scales_.size())
    throw std::invalid_argument(std::to_string(scales.size()) + " lights are dimmed, and the scene has " +
                                std::to_string(scales_.size()));
  for (const auto& scale : scales)
    if (!(std::min({scale.r, scale.g, scale.b}) >= 0 && std::isfinite(scale.r + scale.g + scale.b)))
      throw std::invalid_argument("a light is dimmed to what is no number from 0 on");
  if (scales == scales_) return;
  if (direct_ == Direct::psf)
    throw std::invalid_argument("--direct psf knows no lights that could be dimmed; leave it out");
  scales_ = scales;
  if (light_ != Light::unknown) light_ = Light::moved;
}

Moves LightField::moves_since() const {
  if (light_ == Light::unknown) return {};
  Moves moves{.all = false, .dimmed = scales_ != known_scales_};
  for (std::uint32_t body = 0; body < offsets_.size(); ++body)
    if (offsets_[body] != known_[body]) moves.bodies.push_back({body, known_[body], offsets_[body]});
  return moves;
}

const Solution& LightField::step(const Enough& enough) {
  solution_.bounces = 0;
  if (light_ != Light::settled) advance(enough);
  return solution_;
}

const Solution& LightField::settle() {
  solution_.bounces = 0;
  advance([](std::uint32_t) { return false; });
  solution_.error_estimate = error_estimate();
  if (solution_.bounces >= most_bounces && solution_.residual >= converged) warn_of_no_bound(solution_);
  return solution_;
}

void LightField::advance(const Enough& enough) {
  const auto moves = moves_since();
  // Should it fail half-way, nothing is known.
  const auto before = std::exchange(light_, Light::unknown);
  const bool settled = compute(before, moves, enough, solution_);
  known_ = offsets_;
  known_scales_ = scales_;
  light_ = settled ? Light::settled : Light::rising;
}

LinkCheck LightField::check_links(std::uint32_t pairs) {
  return light_ == Light::unknown ? LinkCheck{} : check_kept_links(pairs);
}

}  // namespace lichtveld::lightfield
