// check(): what a scene holds, lacks and needs.
#include "lichtveld/scene/check.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using testing::Chart;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LogCapture;
using ::testing::Not;
using testing::SceneBuilder;
using ::testing::SizeIs;
using testing::TempFolder;

constexpr float pi = std::numbers::pi_v<float>;

Checked checked(const SceneBuilder& builder, std::uint32_t size = 64, LoadOptions options = {}) {
  const TempFolder folder;
  options.unwrap.size = size;
  LogCapture log;
  auto result = check(folder.write("scene.glb", builder.glb()), options);
  EXPECT_THAT(log.take(), IsEmpty()) << "what is found is returned, not told";
  return result;
}

auto has_id(const std::string& id) {
  return Contains(Field("id", &Finding::id, id));
}

const Finding& finding(const SceneFacts& facts, const std::string& id) {
  const auto found = std::ranges::find(facts.findings, id, &Finding::id);
  if (found == facts.findings.end()) throw std::runtime_error("no finding " + id);
  return *found;
}

// A square metre in the plane y = 0 that looks up.
constexpr std::array<glm::vec3, 4> square = {glm::vec3{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}};

struct Room : SceneBuilder {
  int grey = material(glm::vec3(0.5f)), glow = material(glm::vec3(0), glm::vec3(1, 2, 4)),
      both = material(glm::vec3(0.5f), glm::vec3(0), true);
  Room() { quad("floor", square, {0, 0, 0.5f, 0.5f}, grey); }
};

TEST(SceneCheck, SaysWhatThereIs) {
  Room room;
  room.set_movable(room.box("crate", {0.25f, 0, 0.25f}, {0.75f, 0.5f, 0.75f}, {0.5f, 0.5f, 1, 1}, room.grey));
  const auto [scene, facts] = checked(room);
  EXPECT_EQ(facts.triangles, 14u);
  EXPECT_EQ(facts.pieces, 14u);
  EXPECT_EQ(facts.surfaces, 2u);
  EXPECT_EQ(facts.materials, 1u) << "those that nothing wears do not count";
  EXPECT_NEAR(facts.area, 1 + 6 * 0.25, 1e-6);
  EXPECT_EQ(facts.box.max, glm::vec3(1, 0.5f, 1));
  EXPECT_THAT(facts.movable, ElementsAre(Field("node", &Body::node, "crate")));
  EXPECT_THAT(facts.lights, IsEmpty());
  EXPECT_EQ(scene.indices.size(), 3u * 14);
  EXPECT_THAT(finding(facts, "remark").text, HasSubstr("nothing emits light"));
  EXPECT_THAT(finding(facts, "remark").advice, HasSubstr("--sky"));
}

TEST(SceneCheck, EachLightHasItsFlux) {
  Room room;
  room.quad("lamp", {glm::vec3{0, 2, 0}, {0.5f, 2, 0}, {0.5f, 2, 0.5f}, {0, 2, 0.5f}}, {0.6f, 0, 0.8f, 0.2f},
            room.glow);
  room.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 10}},
      {{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", 0.0}, {"outerConeAngle", pi / 3}}}},
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}}};
  for (const char* name : {"bulb", "torch", "sun"}) {
    auto& nodes = room.gltf["nodes"];
    const std::size_t light = nodes.size() - 2;
    nodes.push_back({{"name", name},
                     {"translation", {0, 1, 0}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    room.gltf["scenes"][0]["nodes"].push_back(nodes.size() - 1);
  }
  room.node(2)["extras"]["switchable"] = true;
  const auto facts = checked(room, 64, {.sky = "1,2,3", .lights = {}, .unwrap = {}}).facts;
  ASSERT_THAT(facts.lights, SizeIs(5));
  const auto light = [&](const std::string& name) {
    return *std::ranges::find(facts.lights, name, &LightFacts::name);
  };
  const auto expect_near = [](const glm::vec3& value, const glm::vec3& expected, const char* what) {
    EXPECT_LT(glm::distance(value, expected), 1e-4f * glm::length(expected) + 1e-9f) << what;
  };
  using Kind = LightFacts::Kind;
  EXPECT_EQ(light("lamp").kind, Kind::surface);
  expect_near(light("lamp").flux, pi * 0.25f * glm::vec3(1, 2, 4), "pi Le A");
  EXPECT_EQ(light("bulb").kind, Kind::point);
  EXPECT_TRUE(light("bulb").switchable);
  EXPECT_FALSE(light("torch").switchable);
  expect_near(light("bulb").flux, glm::vec3(4 * pi * 10), "I of the whole sphere");
  EXPECT_EQ(light("torch").kind, Kind::spot);
  // A smoothstep of the cosine from 1/2 to 1 is a half on the mean: 2 pi (1 - 1/2) / 2.
  expect_near(light("torch").flux, glm::vec3(10 * pi / 2), "spot");
  EXPECT_EQ(light("sun").kind, Kind::directional);
  expect_near(light("sun").irradiance, {3, 1.5f, 0}, "sun");
  EXPECT_EQ(light("sun").flux, glm::vec3(0));
  EXPECT_EQ(light("sky").kind, Kind::sky);
  expect_near(light("sky").irradiance, pi * glm::vec3(1, 2, 3), "pi L");
  EXPECT_EQ(facts.lights[0].name, "bulb") << "the brightest first";
  EXPECT_THAT(facts.switchable, ElementsAre("bulb"));
}

TEST(SceneCheck, ADoubleSidedLampShinesBothWays) {
  SceneBuilder builder;
  builder.quad("lamp", square, {0, 0, 1, 1}, builder.material({}, glm::vec3(2), true));
  EXPECT_NEAR(checked(builder).facts.lights.at(0).flux.r, 2 * pi * 2, 1e-4);
  // It has a chart for each face once it is unwrapped, and gives the same.
  builder.primitive(0)["attributes"].erase("TEXCOORD_1");
  EXPECT_NEAR(checked(builder).facts.lights.at(0).flux.r, 2 * pi * 2, 1e-4);
}

TEST(SceneCheck, MeasuresTheAtlas) {
  // 32 x 32 texels of one square metre, and 16 x 16 of another.
  Room room;
  room.quad("wall", {glm::vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0.5f, 0.5f, 0.75f, 0.75f},
            room.glow);
  const auto atlas = checked(room).facts.atlas;
  EXPECT_EQ(atlas.texels, 32u * 32 + 16 * 16);
  EXPECT_DOUBLE_EQ(atlas.coverage(), (32.0 * 32 + 16 * 16) / (64 * 64));
  EXPECT_EQ(atlas.charts, 2u);
  EXPECT_NEAR(atlas.texels_per_metre.min, 16, 1e-4);
  EXPECT_NEAR(atlas.texels_per_metre.max, 32, 1e-4);
  EXPECT_EQ(atlas.shared.texels, 0u);
  EXPECT_EQ(atlas.charts_without_texel, 0u);
  EXPECT_EQ(atlas.chart_of[0], atlas.chart_of[31 * 64 + 31]);
  EXPECT_NE(atlas.chart_of[0], atlas.chart_of[32 * 64 + 32]);
  EXPECT_EQ(atlas.chart_of[63], AtlasFacts::no_chart);
}

TEST(SceneCheck, HalfOfTheAreaHasTheMedian) {
  Room room;  // 3 square metres at 16 texels a metre beside the floor's one at 32
  room.quad("wall", {glm::vec3{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, {0, 0.5f, 0.75f, 0.75f}, room.glow);
  EXPECT_NEAR(checked(room).facts.atlas.texels_per_metre.median, 16, 1e-4);
}

TEST(SceneCheck, AChartWithoutATexelIsFound) {
  Room room;
  // Between the centres of the texels (40, 40) and (41, 41).
  room.quad("button", {glm::vec3{0, 1, 1}, {0.1f, 1, 1}, {0.1f, 1, 0}, {0, 1, 0}},
            {40.6f / 64, 40.6f / 64, 41.4f / 64, 41.4f / 64}, room.glow);
  const auto facts = checked(room).facts;
  EXPECT_EQ(facts.atlas.charts_without_texel, 1u);
  EXPECT_EQ(facts.atlas.triangles_without_texel, 2u);
  EXPECT_NEAR(facts.atlas.area_without_texel, 0.1, 1e-6);
  ASSERT_THAT(facts.atlas.without_texel, SizeIs(1));
  EXPECT_NEAR(facts.atlas.without_texel[0].x, 41.0 / 64, 0.5 / 64);
  EXPECT_THAT(finding(facts, "charts_without_texel").text, HasSubstr("1 of 2 charts hold no texel's centre"));
  EXPECT_THAT(finding(facts, "charts_without_texel").text, HasSubstr("\"button\""));
  EXPECT_THAT(finding(facts, "charts_without_texel").advice, HasSubstr("--size 128"));
  EXPECT_EQ(checked(room, 128).facts.atlas.charts_without_texel, 0u);
}

TEST(SceneCheck, WhereNoTexelIsCoveredItSaysSo) {
  SceneBuilder builder;
  builder.quad("dot", square, {0.51f, 0.51f, 0.515f, 0.515f}, builder.material({}, glm::vec3(1)));
  const auto facts = checked(builder, 16).facts;
  EXPECT_EQ(facts.atlas.texels, 0u);
  EXPECT_EQ(finding(facts, "no_texel").severity, Finding::Severity::warning);
}

TEST(SceneCheck, SharedTexelsAreNamed) {
  Room room;
  room.quad("wall", {glm::vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0.495f, 0.45f, 1, 1}, room.glow);
  const auto facts = checked(room, 128).facts;
  EXPECT_FALSE(facts.unwrapped) << "so few stay";
  EXPECT_EQ(facts.atlas.shared.texels, 6u);  // one column of 6.4
  EXPECT_TRUE(facts.atlas.shared.at[60 * 128 + 63]);
  EXPECT_FALSE(facts.atlas.shared.at[60 * 128 + 62]);
  ASSERT_THAT(facts.atlas.shared.pairs, SizeIs(1));
  EXPECT_EQ(facts.atlas.shared.pairs[0].b, "wall");
  EXPECT_THAT(finding(facts, "shared_texels").text, HasSubstr("\"floor\" and \"wall\" share 6 texels"));
}

TEST(SceneCheck, WhatIsUnwrappedHasAReason) {
  Room room;
  room.primitive(0)["attributes"].erase("TEXCOORD_1");
  const auto facts = checked(room).facts;
  ASSERT_TRUE(facts.unwrapped);
  EXPECT_THAT(facts.unwrapped->reason, HasSubstr("node \"floor\" has no TEXCOORD_1"));
  EXPECT_EQ(facts.unwrapped->charts, facts.atlas.charts);
  EXPECT_THAT(finding(facts, "unwrapped").text, HasSubstr("no TEXCOORD_1"));
}

TEST(SceneCheck, OneChartDoesNotShowTwoFaces) {
  Room room;
  room.quad("sheet", {glm::vec3{0, 1, 1}, {1, 1, 1}, {1, 1, 0}, {0, 1, 0}}, {0.5f, 0.5f, 1, 1}, room.both);
  room.box("chest", {2, 0, 2}, {3, 1, 3}, {0.5f, 0, 1, 0.5f}, room.both);
  const auto facts = checked(room).facts;
  EXPECT_EQ(facts.meshes.at(1).two_faced, 2u);
  EXPECT_NEAR(facts.meshes.at(1).two_faced_area, 1, 1e-6);
  EXPECT_EQ(facts.meshes.at(2).two_faced, 0u) << "nobody sees the chest from within";
  EXPECT_THAT(finding(facts, "two_faced").text,
              HasSubstr("node \"sheet\": 2 double-sided triangles have one chart for two faces"));
  room.primitive(0)["attributes"].erase("TEXCOORD_1");
  EXPECT_THAT(checked(room).facts.findings, Not(has_id("two_faced"))) << "it is unwrapped, with two charts";
}

TEST(SceneCheck, OpenAndClosedMeshesAreToldApart) {
  Room room;
  room.box("crate", {0, 1, 0}, {1, 2, 1}, {0.5f, 0, 1, 0.5f}, room.grey);
  const auto facts = checked(room).facts;
  EXPECT_EQ(facts.meshes.at(0).boundary_edges, 4u);
  EXPECT_EQ(facts.meshes.at(0).closed_bodies, 0u);
  EXPECT_EQ(facts.meshes.at(1).boundary_edges, 0u) << "corners that coincide are one";
  EXPECT_EQ(facts.meshes.at(1).closed_bodies, 1u);
  EXPECT_EQ(facts.meshes.at(1).non_manifold_edges, 0u);
  EXPECT_EQ(finding(facts, "open").count, 4u);
  EXPECT_EQ(finding(facts, "open").severity, Finding::Severity::note);
  EXPECT_THAT(finding(facts, "open").text, AllOf(HasSubstr("\"floor\""), Not(HasSubstr("crate"))));
}

TEST(SceneCheck, ABodyInsideOutIsNoRoom) {
  Room room;
  room.box("crate", {0, 1, 0}, {1, 2, 1}, {0.5f, 0, 1, 0.5f}, room.grey, true);
  const auto facts = checked(room).facts;
  EXPECT_EQ(facts.meshes.at(1).inside_out, 1u);
  EXPECT_THAT(finding(facts, "inside_out").text, HasSubstr("node \"crate\": 1 closed bodies face inwards"));
  // Around something else it is a room; so is one around a light.
  room.box("ball", {0.4f, 1.4f, 0.4f}, {0.6f, 1.6f, 0.6f}, {0.5f, 0.5f, 1, 1}, room.grey);
  EXPECT_THAT(checked(room).facts.findings, Not(has_id("inside_out")));
  Room lit;
  lit.box("cell", {0, 1, 0}, {1, 2, 1}, {0.5f, 0, 1, 0.5f}, lit.grey, true);
  lit.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  lit.gltf["nodes"].push_back(
      {{"translation", {0.3, 1.5, 0.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  lit.gltf["scenes"][0]["nodes"].push_back(2);
  EXPECT_THAT(checked(lit).facts.findings, Not(has_id("inside_out")));
}

TEST(SceneCheck, EdgesOfManyTrianglesAndOfFacesThatDisagree) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::vec2> uv = {{0, 0}, {0, 1}, {1, 0}, {0, 0}, {0, 0}};
  // A fan of three triangles about one edge.
  builder.mesh("fan", corners, uv, {0, 1, 2, 1, 0, 3, 0, 1, 4}, grey);
  // Two that meet, one of them wound the other way round.
  builder.mesh("bent", corners, uv, {0, 1, 2, 0, 1, 3}, grey);
  // A sheet of two faces, back to back.
  builder.mesh("leaf", corners, uv, {0, 1, 2, 0, 2, 1}, grey);
  const auto facts = checked(builder).facts;
  EXPECT_EQ(facts.meshes.at(0).non_manifold_edges, 1u);
  EXPECT_EQ(facts.meshes.at(0).boundary_edges, 6u);
  EXPECT_EQ(facts.meshes.at(1).flipped_edges, 1u);
  EXPECT_EQ(facts.meshes.at(1).non_manifold_edges, 0u);
  EXPECT_EQ(facts.meshes.at(2).boundary_edges, 0u);
  EXPECT_EQ(facts.meshes.at(2).flipped_edges, 0u);
  EXPECT_EQ(facts.meshes.at(2).closed_bodies, 0u) << "it holds no space";
  EXPECT_THAT(facts.findings, AllOf(has_id("non_manifold"), has_id("flipped_edges")));
}

TEST(SceneCheck, AScaleThatIsNoMetreIsNamed) {
  const auto found = [](float scale) {
    Room room;
    room.node(0)["scale"] = {scale, scale, scale};
    const auto facts = checked(room).facts;
    const auto at = std::ranges::find(facts.findings, "scale", &Finding::id);
    return at == facts.findings.end() ? std::string("none") : at->text;
  };
  EXPECT_EQ(found(4), "none");
  EXPECT_THAT(found(400), HasSubstr("looks like centimetres"));
  EXPECT_THAT(found(4000), HasSubstr("looks like millimetres"));
  EXPECT_THAT(found(4e5f), HasSubstr("enormous"));
  EXPECT_THAT(found(0.04f), HasSubstr("tiny"));
}

TEST(SceneCheck, RemarksOfReadingAreFindings) {
  Room room;
  json points = room.primitive(0);
  points["mode"] = 0;
  for (int i = 0; i < 3; ++i) room.gltf["meshes"][0]["primitives"].push_back(points);
  const auto facts = checked(room, 64, {.sky = "1,1,1", .lights = {}, .unwrap = {}}).facts;
  ASSERT_THAT(facts.remarks, SizeIs(1));
  EXPECT_EQ(facts.remarks[0].count, 3u);
  EXPECT_EQ(text_of(facts.remarks[0]), "3 primitives of points or lines were left out");
  EXPECT_THAT(finding(facts, "remark").advice, Not(IsEmpty()));
}

}  // namespace
}  // namespace lichtveld::scene
