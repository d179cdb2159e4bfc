// The file system as tinygltf may see it, and the call of tinygltf.
#include "model.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compression.hpp"
#include "lichtveld/scene/scene.hpp"
#include "plain.hpp"

namespace lichtveld::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_file_bytes =
    1u << 30;  // a scene and all files beside it, each as often as it is named

// The scene's folder, and how many bytes may still be read from it.
struct Folder {
  fs::path path;
  std::uintmax_t budget = max_file_bytes;
};

std::vector<std::uint8_t> read_file(const fs::path& file, std::uintmax_t limit) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw SceneError("no such file: check the path");
  if (!fs::is_regular_file(status)) throw SceneError("not a file: name a .glb or .gltf file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw SceneError("cannot be read: " + error.message());
  if (size == 0) throw SceneError("empty file");
  if (size > limit) throw SceneError("larger than 1 GiB");
  std::vector<std::uint8_t> bytes(size);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
    throw SceneError("cannot be read: check its permissions");
  }
  return bytes;
}

// URIs were checked already; this also catches symbolic links that lead out of the folder, and the working
// folder, in which tinygltf looks second.
bool lies_beside(const std::string& name, void* folder) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(static_cast<const Folder*>(folder)->path, error);
  const fs::path file = fs::weakly_canonical(name, error);
  return !error && std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end() &&
         fs::is_regular_file(file, error);
}

bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& name, void* user) {
  auto& folder = *static_cast<Folder*>(user);
  try {
    *out = read_file(name, folder.budget);
  } catch (const SceneError& e) {
    *error += e.what();
    return false;
  }
  folder.budget -= out->size();
  return true;
}

// Keeps encoded bytes for later. Those in buffer views are found again through the view.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

bool write_nothing(std::string* error, const std::string&, const std::vector<unsigned char>&, void*) {
  *error += "scenes are only read";
  return false;
}

// tinygltf since 2.9 also asks for a file's size before it reads it, and wants all of its callbacks or none.
template <typename Callbacks>
Callbacks callbacks_beside(Folder& folder) {
  Callbacks callbacks{};
  callbacks.FileExists = &lies_beside;
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = &read_beside;
  callbacks.WriteWholeFile = &write_nothing;
  callbacks.user_data = &folder;
  if constexpr (requires { callbacks.GetFileSizeInBytes; })
    callbacks.GetFileSizeInBytes = [](std::size_t* bytes, std::string* error, const std::string& name, void*) {
      std::error_code failed;
      *bytes = fs::file_size(name, failed);
      if (failed) *error += failed.message();
      return !failed;
    };
  return callbacks;
}

}  // namespace

tinygltf::Model read_model(const fs::path& file, Remarks& remarks) {
  return parse_model(read_file(file, max_file_bytes), file, remarks);
}

Document document_of(const fs::path& file) {
  const auto bytes = read_file(file, max_file_bytes);
  return Document(json_of(bytes));
}

tinygltf::Model parse_model(std::vector<std::uint8_t> contents, const fs::path& file, Remarks& remarks) {
  const std::vector<std::uint8_t> bytes = checked(std::move(contents), remarks);

  Folder folder{file.has_parent_path() ? file.parent_path() : fs::path(".")};
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks(callbacks_beside<tinygltf::FsCallbacks>(folder));
  reader.SetImageLoader(&keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned int>(bytes.size());
  const std::string base = folder.path.string();
  const bool read = bytes.size() > 4 && bytes[0] == 'g'
                        ? reader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, base)
                        : reader.LoadASCIIFromString(&model, &error, &warning,
                                                     reinterpret_cast<const char*>(bytes.data()), size, base);
  // Some of its errors leave out a primitive and go on: what is missing then would be missing in the picture.
  if (!read || !error.empty()) {
    std::ranges::replace(error, '\n', ' ');
    throw SceneError("not valid glTF: " +
                     (error.empty() ? "something that it must say is missing or of another type; "
                                      "the glTF validator tells what (github.khronos.org/glTF-Validator)"
                                    : error));
  }
  std::istringstream lines(warning);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) remarks.add(line);
  decompress(model);
  make_plain(model);
  return model;
}

std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, std::size_t view,
                                             const std::string& what) {
  if (view >= model.bufferViews.size())
    throw SceneError(what + ": there is no buffer view " + std::to_string(view));
  const tinygltf::BufferView& of = model.bufferViews[view];
  return std::span(model.buffers[static_cast<std::size_t>(of.buffer)].data)
      .subspan(of.byteOffset, of.byteLength);
}

std::string node_name(const tinygltf::Model& model, int node) {
  const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? "node " + std::to_string(node) : name;
}

}  // namespace lichtveld::scene
