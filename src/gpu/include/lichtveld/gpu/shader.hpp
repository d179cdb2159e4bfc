// Compiled shaders, and what they declare. The build makes a gpu::Shader of each (cmake/Shaders.cmake).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lichtveld::gpu {

struct Shader {
  std::string_view name;                 // its file's: "brdf.comp"
  std::span<const std::uint32_t> words;  // SPIR-V
};

// texel_buffer: read-only; a shader fetches a texel of up to four words at once, which costs a CPU device a
// quarter of as many loads from a storage buffer.
enum class Kind { sampled_image, storage_image, storage_buffer, texel_buffer };

// A resource that shaders declare in set 0.
struct Slot {
  std::uint32_t binding;
  std::string name;  // the variable's; of a storage buffer the block's
  Kind kind;
  bool writable;  // its declaration lacks `readonly`
};

// All that the shaders of a pipeline declare.
struct Interface {
  std::string shaders;           // their names, for messages
  std::vector<Slot> slots;       // in the order of their bindings
  std::uint32_t push_bytes = 0;  // of push constants
};

}  // namespace lichtveld::gpu
