# lichtveld_module(NAME [PUBLIC targets...] [PRIVATE targets...]): the library lichtveld_NAME from all sources below
# the calling CMakeLists.txt, with its own include folder. What a module may include is what it links, so the build
# keeps the walls between modules.

add_library(lichtveld_options INTERFACE)
target_compile_options(lichtveld_options INTERFACE -Wall -Wextra -Wpedantic -Werror)
if(LICHTVELD_SANITIZE)
  target_compile_options(lichtveld_options INTERFACE -fsanitize=${LICHTVELD_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(lichtveld_options INTERFACE -fsanitize=${LICHTVELD_SANITIZE})
endif()
if(LICHTVELD_SANITIZE MATCHES thread)
  # ThreadSanitizer knows no fences (and GCC says so); what Asio's order, its mutexes order as well.
  target_compile_definitions(lichtveld_options INTERFACE BOOST_ASIO_DISABLE_FENCED_BLOCK)
endif()

function(lichtveld_module name)
  cmake_parse_arguments(MODULE "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  add_library(lichtveld_${name} STATIC ${sources})
  target_include_directories(lichtveld_${name} PUBLIC include PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(lichtveld_${name} PUBLIC ${MODULE_PUBLIC} PRIVATE lichtveld_options ${MODULE_PRIVATE})
endfunction()
