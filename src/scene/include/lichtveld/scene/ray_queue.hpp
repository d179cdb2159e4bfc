// Rays from here and there that are followed together: a packet costs the same whether it is full or not.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "lichtveld/scene/ray_index.hpp"

namespace lichtveld::scene {

// `Of`: what its owner knows a ray by.
template <typename Of>
class RayQueue {
 public:
  // trace(rays, of), a RayPacket and an Of a lane, is called with every packet that is full.
  template <typename Trace>
  void add(const glm::vec3& from, const glm::vec3& direction, const Of& of, const Trace& trace) {
    rays_.set(count_, from, direction);
    of_[count_] = of;
    if (++count_ == RayPacket::size) flush(trace);
  }

  // What is left.
  template <typename Trace>
  void flush(const Trace& trace) {
    if (count_ == 0) return;
    for (std::uint32_t lane = count_; lane < RayPacket::size; ++lane)  // Embree reads the others, too
      rays_.set(lane, {rays_.x[0], rays_.y[0], rays_.z[0]}, {rays_.dx[0], rays_.dy[0], rays_.dz[0]});
    rays_.lanes = (1u << count_) - 1;
    trace(rays_, std::span<const Of>(of_.data(), count_));
    count_ = 0;
  }

 private:
  RayPacket rays_;
  std::array<Of, RayPacket::size> of_;
  std::uint32_t count_ = 0;
};

}  // namespace lichtveld::scene
