# lichtveld_shaders(TARGET shader...): compiles each GLSL file of shaders/ to SPIR-V inside a header,
# "shaders/NAME.STAGE.h" with the array NAME_STAGE, that TARGET can include.
function(lichtveld_shaders target)
  set(folder ${CMAKE_BINARY_DIR}/generated/shaders)
  file(MAKE_DIRECTORY ${folder})
  foreach(shader ${ARGN})
    set(source ${CMAKE_SOURCE_DIR}/shaders/${shader})
    set(header ${folder}/${shader}.h)
    string(REPLACE "." "_" variable ${shader})
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${GLSLANG} -V --quiet --target-env vulkan1.3 -I${CMAKE_SOURCE_DIR}/shaders/include
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
