// Shorthands of glTF written out, so that all others see nodes, meshes and accessors alone.
#pragma once

#include <tiny_gltf.h>

namespace lichtveld::scene {

// A file without scenes gets one of all nodes that are nobody's children. Each instance of a node
// (EXT_mesh_gpu_instancing) becomes a child of that node with the node's name. Indices are where they belong
// again. Throws SceneError, for a node of a mesh that is not there, too.
void make_plain(tinygltf::Model& model);

}  // namespace lichtveld::scene
