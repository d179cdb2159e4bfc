// What a pass binds, held against what its shaders declare, and bound while a command buffer is recorded.
#pragma once

#include "lichtveld/gpu/frame.hpp"

namespace lichtveld::gpu {

// The binding of each of the interface's slots, in their order. Throws std::logic_error as Binding says.
std::vector<const Binding*> match(const Interface& interface, const std::vector<Binding>& bindings);

// Throws std::logic_error for push constants of another size than the shaders'.
void check_push_bytes(const Interface& interface, std::size_t bytes);

// Throws std::logic_error for what is bound and not listed by its pass, or is written and listed as read: its
// barriers would be missing.
void check_listed(const Interface& interface, const std::vector<Binding>& bindings,
                  const std::vector<Binding>& listed);

void push_descriptors(const vk::raii::CommandBuffer& commands, const Pipeline& pipeline,
                      const std::vector<const Binding*>& matched);

}  // namespace lichtveld::gpu
