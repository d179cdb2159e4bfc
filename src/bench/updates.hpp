// What a player's step costs: a walk of the first movable body, with a light map after each step.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"
#include "reference_cache.hpp"
#include "row.hpp"

namespace lichtveld::bench {

struct UpdateOptions {
  std::uint32_t steps = 60;
  std::vector<lightfield::Settings> settings;  // one walk for each, by each method
  std::uint32_t truth_spp = 1024;              // paths a texel of the truth at the walk's end
};

struct UpdateRow {
  std::string scene;
  std::string method = {};
  lightfield::Settings settings;
  std::string choice = {};             // what differs from how links is run otherwise: options; empty: nothing
  std::vector<double> ms = {};         // of each step's light map
  gpu::PassTimes passes = {};          // of all steps together
  double rel_rmse_moving = not_known;  // of the last step's, before it has settled
  double speedup_vs_thesis = 1;        // of the medians
  double rel_rmse = not_known;         // once it has, against the truth of the scene as it then is
  double noise_of_truth = not_known;
};

// Where every body is after each step: the first movable body goes as a player's would, step_length at a time,
// turning where it is blocked. Nothing if no body is movable or the first one has no way to go.
std::vector<scene::Offsets> walk(const scene::Scene& scene, std::uint32_t steps);

// Each method, and after links the same once for each choice that it leaves. Nothing, and a warning, for a
// scene in which nobody can walk.
std::vector<UpdateRow> time_updates(const gpu::Device& device, const scene::Scene& scene,
                                    const std::string& name, const UpdateOptions& options,
                                    const ReferenceCache& cache);

// method, size, psf, ms_p50, ms_p95, speedup_vs_thesis, rel_rmse, scene, steps, rel_rmse_moving
std::string updates_csv(const std::vector<UpdateRow>& rows);

// What each choice saves and costs: scene, size, psf, choice, ms_p50, ms_p95, rel_rmse, rel_rmse_moving
std::string choices_csv(const std::vector<UpdateRow>& rows);

// The same to read, a line a row.
std::string updates_text(const std::vector<UpdateRow>& rows);

}  // namespace lichtveld::bench
