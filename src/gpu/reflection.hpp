// Reads what shaders declare from their SPIR-V.
#pragma once

#include <initializer_list>

#include "lichtveld/gpu/shader.hpp"

namespace lichtveld::gpu {

// Throws std::logic_error, with the shader's and the resource's names, for what pipelines here do not bind.
Interface reflect(const Shader& shader);

// For messages: throws std::logic_error with the shaders' names and these words.
[[noreturn]] void refuse(const Interface& interface, std::initializer_list<std::string_view> why);
const char* kind_name(Kind kind);

// Of a pipeline with both. Throws std::logic_error where they do not agree on a binding or on push constants.
Interface merge(const Interface& vertex, const Interface& fragment);

}  // namespace lichtveld::gpu
