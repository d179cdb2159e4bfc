// The parts of check().
#pragma once

#include "lichtveld/scene/check.hpp"
#include "load_report.hpp"

namespace lichtveld::scene {

// Those with the greatest flux first, then directional lights and the sky.
std::vector<LightFacts> light_facts(const Scene& scene);

// Of the whole triangles of the scene; size is 1..16384.
AtlasFacts atlas_facts(const Scene& scene, const WholeTriangles& whole, std::uint32_t size);

// What of these facts is worth a change, but for the remarks.
std::vector<Finding> findings_in(const SceneFacts& facts);

}  // namespace lichtveld::scene
