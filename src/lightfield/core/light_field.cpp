#include "lichtveld/lightfield/light_field.hpp"

#include <algorithm>
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

Moves LightField::moves_since() const {
  if (light_ == Light::unknown) return {};
  Moves moves{.all = false};
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
  light_ = settled ? Light::settled : Light::rising;
}

LinkCheck LightField::check_links(std::uint32_t pairs) {
  return light_ == Light::unknown ? LinkCheck{} : check_kept_links(pairs);
}

}  // namespace lichtveld::lightfield
