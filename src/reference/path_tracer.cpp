// Shares the texels out among the cores, and the paths of a texel into batches whose spread gives its error.
#include "lichtveld/reference/path_tracer.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "path.hpp"

namespace lichtveld::reference {
namespace {

// Independent estimates a texel: the points of one batch are stratified, so that only batches against each
// other tell the error. 16 know it to 18 % (a chi distribution with 15 degrees of freedom).
constexpr std::uint32_t most_batches = 16;

struct Estimate {
  glm::vec3 irradiance;
  float standard_error;
};

Estimate estimate(const PathTracer& tracer, const Receiver& texel, std::uint32_t index,
                  const Settings& settings, RayCount& count) {
  const std::uint32_t batches = std::min(most_batches, settings.spp);
  glm::dvec3 sum(0);
  std::array<double, most_batches> means, paths;
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    Sampler sampler(settings.seed, index, batch);
    const std::uint32_t in_batch = settings.spp / batches + (batch < settings.spp % batches ? 1 : 0);
    glm::dvec3 batch_sum(0);
    for (std::uint32_t path = 0; path < in_batch; ++path) {
      sampler.begin(path);
      batch_sum += tracer.irradiance(texel, sampler, count);
    }
    sum += batch_sum;
    paths[batch] = in_batch;
    means[batch] = (batch_sum.r + batch_sum.g + batch_sum.b) / (3.0 * in_batch);
  }
  const double mean = (sum.r + sum.g + sum.b) / (3.0 * settings.spp);
  double squares = 0;
  for (std::uint32_t batch = 0; batch < batches; ++batch)
    squares += paths[batch] * (means[batch] - mean) * (means[batch] - mean);
  const double error = batches > 1 ? std::sqrt(squares / ((batches - 1.0) * settings.spp))
                                   : std::numeric_limits<double>::infinity();
  return {sum / static_cast<double>(settings.spp), static_cast<float>(error)};
}

}  // namespace

void check(const Settings& settings) {
  if (settings.size < 16 || settings.size > 4096)
    throw std::invalid_argument("a size of " + std::to_string(settings.size) +
                                " texels: it must lie in 16..4096");
  if (settings.spp < 1 || settings.spp > 1'000'000)
    throw std::invalid_argument(std::to_string(settings.spp) +
                                " paths a texel (spp): there must be 1..1000000");
  if (settings.bounces == 0u)
    throw std::invalid_argument("0 bounces: 1 is direct light alone, 2 adds one reflection");
}

Irradiance trace(const scene::Scene& scene, const std::vector<glm::vec3>& offsets, const Settings& settings) {
  check(settings);
  for (const glm::vec3& offset : offsets)
    if (!std::isfinite(offset.x + offset.y + offset.z))
      throw std::invalid_argument("a body's offset is not finite");

  const Geometry geometry(scene, offsets);
  const PathTracer tracer(geometry, settings.bounces);
  const auto texels = scene::valid_texels(scene, settings.size);
  Irradiance result;
  result.texels.resize(std::size_t{settings.size} * settings.size, glm::vec4(0));
  result.standard_error.resize(result.texels.size(), 0);
  result.texels_valid = static_cast<std::uint32_t>(texels.size());

  progress::Work work("tracing paths", texels.size());
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  // Each texel is one thread's alone, so that their number changes no result.
  const auto trace_texels = [&] {
    RayCount count;
    for (std::size_t i; (i = next++) < texels.size(); work.done()) {
      const auto& [index, hit] = texels[i];
      const Estimate texel =
          estimate(tracer, geometry.receiver(scene::pulled_inside(hit)), index, settings, count);
      result.texels[index] = glm::vec4(texel.irradiance, 1);
      result.standard_error[index] = texel.standard_error;
    }
    const std::lock_guard lock(mutex);
    result.rays += count.rays;
    result.misses += count.misses;
  };
  const std::uint32_t threads =
      settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> workers;
  for (std::uint32_t i = 0; i < threads; ++i) workers.emplace_back(trace_texels);
  workers.clear();
  return result;
}

}  // namespace lichtveld::reference
