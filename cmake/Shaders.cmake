# lichtveld_shaders(TARGET FOLDER): compiles each shader below FOLDER to SPIR-V and gives TARGET a header for each,
# "shaders/NAME.STAGE.h", with the gpu::Shader lichtveld::shaders::NAME_STAGE, which knows its own name. Names are unique
# over all folders. A shader includes what lies beside it or in shaders/include. TARGET_shaders makes these headers
# alone, for tools that only read the code.
function(lichtveld_shaders target root)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  file(MAKE_DIRECTORY ${generated}/spirv)
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS ${root}/*.vert ${root}/*.frag ${root}/*.comp)
  foreach(source ${shaders})
    cmake_path(GET source FILENAME shader)
    set(words ${generated}/spirv/${shader}.h)
    if(words IN_LIST headers)
      message(FATAL_ERROR "Two shaders are called ${shader}: a shader's name is its pass', and there is one")
    endif()
    string(REPLACE "." "_" variable ${shader})
    add_custom_command(
      OUTPUT ${words}
      COMMAND ${GLSLANG} -V --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR}/shaders/include
              --vn ${variable}_words --depfile ${words}.d -o ${words} ${source}
      DEPENDS ${source}
      DEPFILE ${words}.d
      COMMENT "Shader ${shader}"
      VERBATIM)
    file(CONFIGURE OUTPUT ${generated}/shaders/${shader}.h @ONLY CONTENT [[
#pragma once
#include "lichtveld/gpu/shader.hpp"
namespace lichtveld::shaders {
#include "spirv/@shader@.h"
constexpr gpu::Shader @variable@{"@shader@", @variable@_words};
}
]])
    list(APPEND headers ${words})
  endforeach()
  add_custom_target(${target}_shaders DEPENDS ${headers})
  target_sources(${target} PRIVATE ${headers})
  target_include_directories(${target} PRIVATE ${generated})
endfunction()
