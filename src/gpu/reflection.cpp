#include "reflection.hpp"

#include <spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace lichtveld::gpu {

namespace {

// A module as SPIRV-Cross sees it. Everything that it hands out lives as long as its context.
class Module {
 public:
  explicit Module(const Shader& shader) : shader_(shader) {
    spvc_context context = nullptr;
    check(spvc_context_create(&context));
    context_.reset(context);
    spvc_parsed_ir parsed = nullptr;
    check(spvc_context_parse_spirv(context, shader.words.data(), shader.words.size(), &parsed));
    check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                       &compiler_));
    check(spvc_compiler_create_shader_resources(compiler_, &resources_));
  }

  std::span<const spvc_reflected_resource> resources(spvc_resource_type type) const {
    const spvc_reflected_resource* list = nullptr;
    std::size_t count = 0;
    check(spvc_resources_get_resource_list_for_type(resources_, type, &list, &count));
    return {list, count};
  }
  std::uint32_t decoration(const spvc_reflected_resource& resource, SpvDecoration decoration) const {
    return spvc_compiler_get_decoration(compiler_, resource.id, decoration);
  }
  bool is_array(const spvc_reflected_resource& resource) const {
    return spvc_type_get_num_array_dimensions(type_of(resource)) > 0;
  }
  bool is_buffer(const spvc_reflected_resource& image) const {
    return spvc_type_get_image_dimension(type_of(image)) == SpvDimBuffer;
  }
  bool is_readonly_image(const spvc_reflected_resource& image) const {
    return spvc_compiler_has_decoration(compiler_, image.id, SpvDecorationNonWritable) == SPVC_TRUE;
  }
  // A block's qualifiers stand at its members: these are what all of them have.
  bool is_readonly_block(const spvc_reflected_resource& block) const {
    const SpvDecoration* list = nullptr;
    std::size_t count = 0;
    check(spvc_compiler_get_buffer_block_decorations(compiler_, block.id, &list, &count));
    return std::count(list, list + count, SpvDecorationNonWritable) > 0;
  }
  std::uint32_t bytes(const spvc_reflected_resource& block) const {
    std::size_t size = 0;
    check(spvc_compiler_get_declared_struct_size(
        compiler_, spvc_compiler_get_type_handle(compiler_, block.base_type_id), &size));
    return static_cast<std::uint32_t>(size);
  }

 private:
  spvc_type type_of(const spvc_reflected_resource& resource) const {
    return spvc_compiler_get_type_handle(compiler_, resource.type_id);
  }
  void check(spvc_result result) const {
    if (result == SPVC_SUCCESS) return;
    throw std::logic_error(std::string(shader_.name) + ": its SPIR-V cannot be read: " +
                           (context_ ? spvc_context_get_last_error_string(context_.get()) : "no memory"));
  }

  struct Destroy {
    void operator()(spvc_context context) const { spvc_context_destroy(context); }
  };
  const Shader& shader_;
  std::unique_ptr<spvc_context_s, Destroy> context_;
  spvc_compiler compiler_ = nullptr;
  spvc_resources resources_ = nullptr;
};

void add(Interface& interface, const Module& module, const spvc_reflected_resource& resource, Kind kind,
         bool writable) {
  const std::string name = resource.name;
  if (module.decoration(resource, SpvDecorationDescriptorSet) != 0 || module.is_array(resource))
    refuse(interface, {"\"", name, "\" is an array of bindings, or not in set 0"});
  interface.slots.push_back({module.decoration(resource, SpvDecorationBinding), name, kind, writable});
}

std::string described(const Slot& slot) {
  return "\"" + slot.name + "\" is binding " + std::to_string(slot.binding) + ", a " + kind_name(slot.kind);
}

// In the order of the bindings, no two of which share a number or a name.
void sort(Interface& interface) {
  auto& slots = interface.slots;
  std::sort(slots.begin(), slots.end(), [](const Slot& a, const Slot& b) { return a.binding < b.binding; });
  for (auto slot = slots.begin(); slot != slots.end(); ++slot)
    for (auto before = slots.begin(); before != slot; ++before)
      if (before->binding == slot->binding || before->name == slot->name)
        refuse(interface, {described(*before), ", and ", described(*slot)});
}

}  // namespace

void refuse(const Interface& interface, std::initializer_list<std::string_view> why) {
  auto message = interface.shaders + ": ";
  for (const auto part : why) message += part;
  throw std::logic_error(message);
}

const char* kind_name(Kind kind) {
  constexpr const char* names[] = {"sampled image", "storage image", "storage buffer", "texel buffer"};
  return names[static_cast<int>(kind)];
}

// All that a module declares counts, used or not: glslang keeps what is not used.
Interface reflect(const Shader& shader) {
  const Module module(shader);
  Interface interface {
    .shaders = std::string(shader.name), .slots = {}
  };
  for (const auto& image : module.resources(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE))
    add(interface, module, image, module.is_buffer(image) ? Kind::texel_buffer : Kind::sampled_image, false);
  for (const auto& image : module.resources(SPVC_RESOURCE_TYPE_STORAGE_IMAGE))
    add(interface, module, image, Kind::storage_image, !module.is_readonly_image(image));
  for (const auto& block : module.resources(SPVC_RESOURCE_TYPE_STORAGE_BUFFER))
    add(interface, module, block, Kind::storage_buffer, !module.is_readonly_block(block));
  // Since SPIR-V 1.6 a samplerBuffer is an image without a sampler.
  for (const auto& image : module.resources(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE)) {
    if (!module.is_buffer(image)) refuse(interface, {"\"", image.name, "\" is an image without a sampler"});
    add(interface, module, image, Kind::texel_buffer, false);
  }
  for (const auto type :
       {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, SPVC_RESOURCE_TYPE_SUBPASS_INPUT, SPVC_RESOURCE_TYPE_ATOMIC_COUNTER,
        SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE})
    for (const auto& other : module.resources(type))
      refuse(interface, {"\"", other.name, "\" is of a kind that no pipeline here binds"});
  for (const auto& block : module.resources(SPVC_RESOURCE_TYPE_PUSH_CONSTANT))
    interface.push_bytes = module.bytes(block);
  sort(interface);
  return interface;
}

Interface merge(const Interface& vertex, const Interface& fragment) {
  Interface both = vertex;
  both.shaders += " + " + fragment.shaders;
  for (const auto& slot : fragment.slots) {
    const auto same = std::find_if(both.slots.begin(), both.slots.end(), [&](const Slot& other) {
      return other.binding == slot.binding && other.name == slot.name && other.kind == slot.kind;
    });
    if (same == both.slots.end())
      both.slots.push_back(slot);
    else
      same->writable |= slot.writable;
  }
  sort(both);
  if (fragment.push_bytes > 0 && vertex.push_bytes > 0 && fragment.push_bytes != vertex.push_bytes)
    refuse(both, {"push constants of ", std::to_string(vertex.push_bytes), " bytes, and of ",
                  std::to_string(fragment.push_bytes)});
  both.push_bytes = std::max(vertex.push_bytes, fragment.push_bytes);
  return both;
}

}  // namespace lichtveld::gpu
