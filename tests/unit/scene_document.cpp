// The JSON of a file: what its extras hold costs no more than their text, and stays as it is.
#include "document.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "lichtveld/scene/unwrap.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::LogCapture;
using testing::SceneBuilder;
using testing::TempFolder;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

json read(const std::string& text, bool left_out_as_well) {
  bool left_out = false;
  json root = read_document(bytes_of(text), left_out);
  EXPECT_EQ(left_out, left_out_as_well) << text;
  return root;
}

TEST(SceneDocument, OfExtrasIsReadWhatASceneIsReadBy) {
  EXPECT_EQ(read(R"({"nodes": [{"extras": {"movable": true, "texels": 2}}]})", false),
            json::parse(R"({"nodes": [{"extras": {"movable": true, "texels": 2}}]})"));
  EXPECT_EQ(
      read(R"({"a": {"extras": {"sky": [1, 2, 3], "of": {"movable": true}, "to": [[]]}, "b": []}})", true),
      json::parse(R"({"a": {"extras": {"sky": [1, 2, 3]}, "b": []}})"));
  EXPECT_EQ(read(R"({"extras": [1, {"sky": 2}], "a": "extras", "b": {"extras": 3}})", true),
            json::parse(R"({"extras": null, "a": "extras", "b": {"extras": 3}})"));
  EXPECT_EQ(read(R"({"extras": {"sky": [[1], {"a": 2}, 3]}})", true)["extras"]["sky"],
            json::parse("[null, null, 3]"));
  std::string many = R"({"extras": {"sky": [0)";
  for (int i = 0; i < 1000; ++i) many += ",0";
  EXPECT_EQ(read(many + "]}}", true)["extras"]["sky"].size(), 16u);
}

TEST(SceneDocument, ExtrasAreWrittenAsTheyWere) {
  const std::string extras = R"({ "a" : [ 0, 1.50, "\u0065]}" ], "extras": {} })", list = "[ 1e2 ]";
  Document document(bytes_of(R"({"nodes": [{"extras": )" + extras + R"(}, {"extras": )" + list +
                             R"(}, {"extras": 5}], "extras": {}})"));
  document.root["nodes"].push_back(document.root["nodes"][1]);
  document.root["nodes"][2]["name"] = "new";
  EXPECT_EQ(document.text(), R"({"extras":{},"nodes":[{"extras":)" + extras + R"(},{"extras":)" + list +
                                 R"(},{"extras":5,"name":"new"},{"extras":)" + list + "}]}");
}

TEST(SceneDocument, ListsTakeTimeInProportion) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  builder.quad("floor", {glm::vec3{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, {0, 0, 1, 1}, grey);
  for (int node = 1; node <= 200'000; ++node) {
    builder.gltf["nodes"].push_back(json::object());
    builder.gltf["scenes"][0]["nodes"].push_back(node);
  }
  const TempFolder folder;
  const auto file = folder.write("scene.glb", builder.glb());
  LogCapture log;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(load(file).indices.size(), 6u);
  // In proportion it is 1 s on a slow machine, by the square of their number 40 s.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15));
}

}  // namespace
}  // namespace lichtveld::scene
