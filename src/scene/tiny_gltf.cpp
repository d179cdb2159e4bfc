// tinygltf is header-only: its implementation is compiled here, once.
#include <fstream>  // which it forgets to include where it is told to leave file access to us

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
