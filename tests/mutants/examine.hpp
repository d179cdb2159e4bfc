// What `lichtveld check` and `lichtveld bake` do, done to a mutant, and what must hold whatever it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"
#include "mutate.hpp"

namespace lichtveld::mutants {

// What is done beside loading, looking and baking, as it takes its time.
struct Care {
  bool trial = false;     // check's forecast
  bool shown = false;     // bake's --png
  bool unwrapped = true;  // bake's --gltf, and that it loads
};

struct Verdict {
  std::string refusal;              // the message, without the file's path; empty where it was baked
  std::vector<std::string> faults;  // what must not be
};

// In a folder that holds nothing else and is empty afterwards. `doing` is called with what is begun.
Verdict examine(const Mutant& mutant, const std::filesystem::path& folder, const gpu::Device& device,
                const Care& care, void (*doing)(const char* what));

}  // namespace lichtveld::mutants
