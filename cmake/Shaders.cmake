# lichtveld_shaders(TARGET): compiles each shader below shaders/ to SPIR-V inside a header, "shaders/NAME.STAGE.h"
# with the array NAME_STAGE, that TARGET can include. Names are unique over all folders. A shader includes what lies
# beside it or in shaders/include.
function(lichtveld_shaders target)
  set(root ${CMAKE_SOURCE_DIR}/shaders)
  set(folder ${CMAKE_BINARY_DIR}/generated/shaders)
  file(MAKE_DIRECTORY ${folder})
  file(GLOB_RECURSE shaders CONFIGURE_DEPENDS ${root}/*.vert ${root}/*.frag ${root}/*.comp)
  foreach(source ${shaders})
    cmake_path(GET source FILENAME shader)
    set(header ${folder}/${shader}.h)
    if(header IN_LIST headers)
      message(FATAL_ERROR "Two shaders are called ${shader}: a shader's name is its pass', and there is one")
    endif()
    string(REPLACE "." "_" variable ${shader})
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${GLSLANG} -V --quiet --target-env vulkan1.3 -I${root}/include
              --vn ${variable} --depfile ${header}.d -o ${header} ${source}
      DEPENDS ${source}
      DEPFILE ${header}.d
      COMMENT "Shader ${shader}"
      VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  target_sources(${target} PRIVATE ${headers})
  target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/generated)
endfunction()
