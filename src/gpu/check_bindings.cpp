#include <algorithm>

#include "bindings.hpp"
#include "reflection.hpp"

namespace lichtveld::gpu {

namespace {

// The resource behind a binding.
const std::string& resource_of(const Binding& binding) {
  return binding.image != nullptr ? binding.image->name() : binding.buffer->name();
}

std::string described(const Binding& binding) {
  return kind_name(binding.kind) + (" " + resource_of(binding));
}

template <typename Named>
std::string names_of(const std::vector<Named>& all) {
  std::string names;
  for (const auto& one : all) names.append(names.empty() ? "" : ", ").append(one.name);
  return names.empty() ? "nothing" : names;
}

void check(const Interface& interface, const Slot& slot, const Binding& binding) {
  const auto& resource = resource_of(binding);
  if (binding.kind != slot.kind)
    refuse(interface, {"binding \"", slot.name, "\" is a ", kind_name(slot.kind),
                       " in the shader, and bound as the ", described(binding)});
  if (slot.writable && !binding.writes)
    refuse(interface, {"binding \"", slot.name, "\" may be written by the shader, which does not declare it ",
                       "readonly, and ", resource, " is bound by reads()"});
  if (!slot.writable && binding.writes)
    refuse(interface, {"binding \"", slot.name, "\" is declared readonly by the shader, and ", resource,
                       " is bound by writes()"});
  if (binding.kind == Kind::texel_buffer && !binding.buffer->texels())
    refuse(interface, {"binding \"", slot.name, "\" is fetched as texels by the shader, and ", resource,
                       " was made without a format of them"});
}

}  // namespace

std::vector<const Binding*> match(const Interface& interface, const std::vector<Binding>& bindings) {
  const auto& slots = interface.slots;
  std::vector<const Binding*> matched(slots.size());
  for (const Binding& binding : bindings) {
    const auto slot = std::find_if(slots.begin(), slots.end(),
                                   [&](const Slot& candidate) { return candidate.name == binding.name; });
    if (slot == slots.end())
      refuse(interface, {"binding \"", binding.name, "\" (", described(binding),
                         ") is not in the shader, which declares ", names_of(slots)});
    const Binding*& taken = matched[slot - slots.begin()];
    if (taken != nullptr)
      refuse(interface, {"binding \"", binding.name, "\" is given twice: as ", described(*taken), " and as ",
                         described(binding)});
    check(interface, *slot, binding);
    taken = &binding;
  }
  const auto missing = std::find(matched.begin(), matched.end(), nullptr);
  if (missing != matched.end()) {
    const Slot& slot = slots[missing - matched.begin()];
    refuse(interface, {"binding \"", slot.name, "\", a ", kind_name(slot.kind),
                       " of the shader, is missing: bound is ", names_of(bindings)});
  }
  return matched;
}

void check_push_bytes(const Interface& interface, std::size_t bytes) {
  if (bytes == interface.push_bytes) return;
  refuse(interface, {"the shader declares ", std::to_string(interface.push_bytes),
                     " bytes of push constants, and ", std::to_string(bytes), " were given"});
}

void check_listed(const Interface& interface, const std::vector<Binding>& bindings,
                  const std::vector<Binding>& listed) {
  for (const Binding& binding : bindings)
    if (std::none_of(listed.begin(), listed.end(), [&](const Binding& other) {
          return other.image == binding.image && other.buffer == binding.buffer && other.kind == binding.kind &&
                 (other.writes || !binding.writes);
        }))
      refuse(interface, {"binding \"", binding.name, "\" (", described(binding),
                         ") is not listed by the pass that binds it"});
}

}  // namespace lichtveld::gpu
