// Shares the texels out among the cores, and the paths of a texel into batches whose spread gives its error.
#include "lichtveld/reference/path_tracer.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

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

// What the threads share. Each texel is one thread's alone, so that their number changes no result.
struct Work {
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex mutex;
  std::condition_variable finished;
  std::uint32_t running = 0;  // threads
  RayCount count;
};

void report_until_finished(Work& work, std::size_t texels, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(work.mutex);
  while (!work.finished.wait_for(lock, std::chrono::seconds(1), [&] { return work.running == 0; })) {
    const std::size_t done = work.done;
    if (!progress || done == 0) continue;
    const double share = static_cast<double>(done) / static_cast<double>(texels);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    lock.unlock();
    progress(share, std::chrono::ceil<std::chrono::seconds>(passed * ((1 - share) / share)));
    lock.lock();
  }
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

Irradiance trace(const scene::Scene& scene, const std::vector<glm::vec3>& offsets, const Settings& settings,
                 const Progress& progress) {
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

  Work work;
  const auto trace_texels = [&](const std::stop_token& stop) {
    RayCount count;
    for (std::size_t i; !stop.stop_requested() && (i = work.next++) < texels.size(); ++work.done) {
      const auto& [index, hit] = texels[i];
      const Estimate texel =
          estimate(tracer, geometry.receiver(scene::pulled_inside(hit)), index, settings, count);
      result.texels[index] = glm::vec4(texel.irradiance, 1);
      result.standard_error[index] = texel.standard_error;
    }
    const std::lock_guard lock(work.mutex);
    work.count.rays += count.rays;
    work.count.misses += count.misses;
    if (--work.running == 0) work.finished.notify_one();
  };

  const std::uint32_t threads =
      settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  work.running = threads;
  {
    std::vector<std::jthread> workers;
    for (std::uint32_t i = 0; i < threads; ++i) workers.emplace_back(trace_texels);
    report_until_finished(work, texels.size(), progress);
  }
  result.rays = work.count.rays;
  result.misses = work.count.misses;
  return result;
}

}  // namespace lichtveld::reference
