// Traced light maps, kept in files: the truth takes minutes, and bench asks for the same one again and again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/reference/path_tracer.hpp"

namespace lichtveld::bench {

class ReferenceCache {
 public:
  // Makes the folder. Throws files::OutputError if that cannot be.
  explicit ReferenceCache(std::filesystem::path folder);

  // trace() with body i shifted by offsets[i], from the cache or anew. A file is used only if it is whole and
  // was made from the same scene file (by its SHA-256), places, size, bounces, spp and seed; any other is
  // traced anew and replaced. Scenes that are no .glb are always traced: their triangles lie in files that no
  // hash covers.
  reference::Irradiance traced(const scene::Scene& scene, const std::vector<glm::vec3>& offsets,
                               const reference::Settings& settings) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace lichtveld::bench
