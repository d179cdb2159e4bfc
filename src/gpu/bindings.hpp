// Binds resources to a pipeline while a command buffer is recorded.
#pragma once

#include "lichtveld/gpu/frame.hpp"

namespace lichtveld::gpu {

// Pushes the bindings as descriptors, in the order of the pipeline's kinds.
void push_descriptors(const vk::raii::CommandBuffer& commands, const Pipeline& pipeline,
                      const std::vector<Binding>& bindings);

}  // namespace lichtveld::gpu
