# Every library that the project uses, found once. `./dev build` installs what is missing.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Vulkan REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers only
find_package(glm REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(TBB REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
# Its package file does not ask for OpenSSL and Threads itself; both stand above.
find_package(LibDataChannel REQUIRED)
# OpenImageIO's own package file wants tools that Debian leaves out of it.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
# Its own package files are unequal between releases, and the C library is the part that keeps its interface.
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_path(STB_INCLUDE_DIR stb_rect_pack.h PATH_SUFFIXES stb REQUIRED)
# For --capture, which says so where the header was missing. The library itself is loaded when it is asked for.
find_path(RENDERDOC_INCLUDE_DIR renderdoc_app.h)
find_program(GLSLANG glslangValidator REQUIRED)
if(LICHTVELD_TESTS)
  find_package(GTest REQUIRED)
endif()
