// unwrap(): an atlas for scenes that have none, or one that cannot be used.
#include "lichtveld/scene/unwrap.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "lichtveld/scene/atlas.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LogCapture;
using ::testing::Not;
using testing::SceneBuilder;
using testing::TempFolder;

constexpr std::uint32_t size = 128;

void forget_atlas(SceneBuilder& builder) {
  for (auto& mesh : builder.gltf["meshes"])
    for (auto& primitive : mesh["primitives"]) primitive["attributes"].erase("TEXCOORD_1");
}

struct Case {
  explicit Case(const SceneBuilder& builder) : file(folder.write("scene.glb", builder.glb())) {}

  Scene loaded() const { return load(file, {.sky = {}, .lights = {}, .unwrap = {.size = size}}); }
  Unwrapped unwrapped() const { return unwrap(file, {.size = size}); }
  json written() const {
    const auto& glb = unwrapped().glb;
    std::uint32_t length = 0;
    std::memcpy(&length, &glb[12], 4);
    return json::parse(glb.begin() + 20, glb.begin() + 20 + length);
  }

  TempFolder folder;
  std::filesystem::path file;
};

// A room with a crate in it, without TEXCOORD_1.
SceneBuilder room() {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f)), lamp = builder.material(glm::vec3(0), glm::vec3(5));
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 1}, grey, true);
  builder.box("crate", {0.5f, 0, 0.5f}, {1.5f, 1, 1.5f}, {0, 0, 1, 1}, grey);
  builder.quad(
      "lamp", {glm::vec3{-0.5f, 2.99f, -0.5f}, {0.5f, 2.99f, -0.5f}, {0.5f, 2.99f, 0.5f}, {-0.5f, 2.99f, 0.5f}},
      {0, 0, 1, 1}, lamp);
  forget_atlas(builder);
  return builder;
}

// For each triangle its chart: triangles that share an edge's ends there and in space are of one.
std::vector<std::size_t> charts_in(const Scene& scene) {
  std::vector<std::size_t> parent(scene.indices.size() / 3);
  std::iota(parent.begin(), parent.end(), 0u);
  const std::function<std::size_t(std::size_t)> find = [&](std::size_t t) {
    return parent[t] == t ? t : parent[t] = find(parent[t]);
  };
  std::map<std::array<float, 5>, std::size_t> first;
  for (std::size_t i = 0; i < scene.indices.size(); ++i) {
    const auto& v = scene.vertices[scene.indices[i]];
    const auto [found, is_new] =
        first.try_emplace({v.position.x, v.position.y, v.position.z, v.atlas.x, v.atlas.y}, i / 3);
    parent[find(i / 3)] = find(found->second);
  }
  std::vector<std::size_t> charts;
  for (std::size_t t = 0; t < parent.size(); ++t) charts.push_back(find(t));
  return charts;
}

double area_of(const Scene& scene, std::size_t triangle) {
  const auto at = [&](std::size_t k) {
    return glm::dvec3(scene.vertices[scene.indices[3 * triangle + k]].position);
  };
  return glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
}

// Nothing overlaps, charts are so many texels apart, and each that is a few texels large has as many a square
// metre as the whole.
void expect_good_atlas(const Scene& scene, std::int64_t gap = 2) {
  LogCapture log;
  check_atlas(scene, size);
  EXPECT_THAT(log.take(), Not(HasSubstr("overlap")));
  const auto charts = charts_in(scene);
  std::map<std::int64_t, std::size_t> chart_at;
  std::map<std::size_t, double> texels, area;
  for (const auto& texel : valid_texels(scene, size)) {
    chart_at[texel.index] = charts[texel.at.triangle];
    ++texels[charts[texel.at.triangle]];
  }
  double all_texels = 0, all_area = 0;
  for (std::size_t t = 0; t < charts.size(); ++t) area[charts[t]] += area_of(scene, t);
  for (const auto& [chart, of] : area) all_texels += texels[chart], all_area += of;
  for (const auto& [chart, count] : texels) {
    if (count < 100) continue;
    EXPECT_NEAR(count / area[chart], all_texels / all_area, 0.2 * all_texels / all_area) << "chart " << chart;
  }
  for (const auto& [index, chart] : chart_at)
    for (std::int64_t y = -gap; y <= gap; ++y)
      for (std::int64_t x = -gap; x <= gap; ++x) {
        const std::int64_t column = index % size + x;
        const auto other = column < 0 || column >= size ? chart_at.end() : chart_at.find(index + y * size + x);
        if (other == chart_at.end()) continue;
        ASSERT_EQ(other->second, chart) << index % size << ", " << index / size;
      }
}

TEST(SceneUnwrap, ARoomWithoutChartsGetsThem) {
  LogCapture log;
  const Case of(room());
  const Scene scene = of.loaded();
  EXPECT_THAT(log.take(), HasSubstr("unwrapped into 13 charts"));
  expect_good_atlas(scene);
  // Flat rectangles lie on whole texels, and fill most of the square.
  for (const auto& vertex : scene.vertices)
    for (int axis = 0; axis < 2; ++axis)
      EXPECT_NEAR(vertex.atlas[axis] * size, std::round(vertex.atlas[axis] * size), 1e-3);
  EXPECT_GT(valid_texels(scene, size).size(), 0.6 * size * size);
  EXPECT_EQ(scene.indices.size(), 3u * 26);
}

TEST(SceneUnwrap, TheSameFileGivesTheSameBytes) {
  const Case of(room());
  const auto first = of.unwrapped();
  EXPECT_EQ(first.glb, of.unwrapped().glb);
  EXPECT_EQ(first.charts, 13u);
  // What it wrote needs no more of it.
  const TempFolder folder;
  const auto again = unwrap(folder.write("again.glb", {first.glb.begin(), first.glb.end()}), {.size = size});
  EXPECT_THAT(again.reason, IsEmpty());
  const Case same(room());
  LogCapture log;
  const Scene scene = same.loaded();
  EXPECT_EQ(scene.unwrapped, first.glb);
}

TEST(SceneUnwrap, LeavesTheRestOfTheFileAsItIs) {
  auto builder = room();
  builder.gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  builder.gltf["nodes"][1]["extras"] = {{"movable", true}, {"of", {1, 2}}};
  builder.gltf["materials"][0]["extras"] = "paint";
  const int times = builder.accessor(std::vector<float>{0, 1}, 5126, "SCALAR");
  const int places = builder.accessor(std::vector<glm::vec3>{{0, 0, 0}, {0, 1, 0}}, 5126, "VEC3");
  builder.gltf["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", places}}}}}};
  const Case of(builder);
  const json written = of.written();
  for (const char* key : {"asset", "cameras", "scenes", "scene", "materials"})
    EXPECT_EQ(written[key], builder.gltf[key]) << key;
  EXPECT_EQ(written["nodes"][1]["extras"], builder.gltf["nodes"][1]["extras"]);
  EXPECT_EQ(written["animations"][0]["channels"], builder.gltf["animations"][0]["channels"]);
  const auto input = written["animations"][0]["samplers"][0]["input"].get<std::size_t>();
  EXPECT_EQ(written["accessors"][input]["count"], 2);
  EXPECT_TRUE(of.loaded().bodies.size() == 2);
}

TEST(SceneUnwrap, NodesOfAMeshShareAllButTheirCharts) {
  auto builder = room();
  json again = builder.node(1);
  again["name"] = "another crate";
  again["translation"] = {-2, 0, 0};
  builder.gltf["nodes"].push_back(again);
  builder.gltf["scenes"][0]["nodes"].push_back(3);
  const Case of(builder);
  const json written = of.written();
  const auto attributes = [&](std::size_t node) {
    return written["meshes"][written["nodes"][node]["mesh"].get<std::size_t>()]["primitives"][0]["attributes"];
  };
  EXPECT_EQ(attributes(1)["POSITION"], attributes(3)["POSITION"]);
  EXPECT_NE(attributes(1)["TEXCOORD_1"], attributes(3)["TEXCOORD_1"]);
  LogCapture log;
  expect_good_atlas(of.loaded());
}

TEST(SceneUnwrap, ChartsOfOnesOwnThatFillTheSquareEachArePacked) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  // Twice as wide as high, in a square of their own.
  for (float y : {0.0f, 1.0f, 3.0f})
    builder.quad("wall", {glm::vec3{0, y, 0}, {2, y, 0}, {2, y + 1, 0}, {0, y + 1, 0}}, {0, 0, 1, 1}, grey);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_THAT(log.take(), HasSubstr("overlap in TEXCOORD_1"));
  expect_good_atlas(scene);
  const auto extent = [&](int axis) {
    const auto [low, high] = std::ranges::minmax(std::span(scene.vertices).first(4), {},
                                                 [&](const Vertex& vertex) { return vertex.atlas[axis]; });
    return high.atlas[axis] - low.atlas[axis];
  };
  EXPECT_NEAR(extent(0), extent(1), 1e-6) << "it is no square any more";
}

TEST(SceneUnwrap, AFewSharedTexelsAreToldAndStay) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  builder.quad("floor", {glm::vec3{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, {0, 0, 0.5f, 1}, grey);
  builder.quad("wall", {glm::vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0.495f, 0.9f, 1, 1}, grey);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_EQ(scene.vertices[0].atlas, glm::vec2(0, 1));
  check_atlas(scene, size);
  EXPECT_THAT(log.take(), HasSubstr("\"floor\" and \"wall\" share 13 of 128 x 128 texels"));
}

TEST(SceneUnwrap, CopiesThatShareAnAtlasStay) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  // The second pair of triangles is the first, from other corners on.
  builder.mesh("floor", {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
               {0, 1, 2, 0, 2, 3, 1, 2, 0, 3, 0, 2}, grey);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_THAT(scene.unwrapped, IsEmpty());
  check_atlas(scene, size);
  EXPECT_THAT(log.take(), IsEmpty());
}

TEST(SceneUnwrap, AHairOutsideIsPulledIn) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  builder.quad("floor", {glm::vec3{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, {0, 0, 1.00008f, 1}, grey);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_EQ(scene.vertices[1].atlas, glm::vec2(1, 1));
  EXPECT_THAT(log.take(), HasSubstr("3 coordinates of TEXCOORD_1 lie a hair outside 0..1"));
}

TEST(SceneUnwrap, WhatFoldsOrHasNoPlaceIsLaidAnew) {
  for (const auto& spoilt : {std::vector<glm::vec2>{{0, 1}, {1, 1}, {1, 0}, {1, 1}},  // onto itself
                             std::vector<glm::vec2>{{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}},
                             std::vector<glm::vec2>{{std::nanf(""), 0}, {1, 1}, {1, 0}, {1, 1}},
                             std::vector<glm::vec2>{{1e30f, 0}, {1, 1}, {1, 0}, {1, 1}}}) {
    SceneBuilder builder;
    const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
    builder.mesh("folded", {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, spoilt, {0, 1, 2, 0, 2, 3}, grey);
    const Case of(builder);
    LogCapture log;
    const Scene scene = of.loaded();
    EXPECT_THAT(log.take(), HasSubstr("2 triangles of its charts fold or have no area, and are laid anew"));
    expect_good_atlas(scene);
    EXPECT_GT(valid_texels(scene, size).size(), 0.9 * size * size);
  }
}

// What folds leaves no mark where the next chart of its mesh is looked at.
TEST(SceneUnwrap, OneChartThatFoldsCostsNoOther) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  std::vector<glm::vec3> corners;
  for (const float y : {0.0f, 1.0f})
    for (const glm::vec2 at : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)})
      corners.emplace_back(at.x, y, at.y);
  builder.mesh("two", corners, {{0, 1}, {1, 1}, {1, 0}, {1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}},
               {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}, grey);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_THAT(log.take(), HasSubstr("; 2 triangles of its charts fold"));
  expect_good_atlas(scene);
}

TEST(SceneUnwrap, CopiesOfFacesShareTexels) {
  auto builder = room();
  // The floor once more, its corners in another order.
  builder.mesh("copy", {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, std::vector<glm::vec2>(4),
               {0, 1, 2, 0, 2, 3, 1, 2, 0, 3, 0, 2}, 0);
  forget_atlas(builder);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  EXPECT_THAT(log.take(), HasSubstr("unwrapped into 14 charts"));
  check_atlas(scene, size);
  EXPECT_THAT(log.take(), Not(HasSubstr("overlap")));
  std::vector<glm::vec2> places;
  for (const auto& surface : scene.surfaces)
    if (surface.node == "copy")
      for (std::uint32_t i = 0; i < surface.index_count; ++i)
        places.push_back(scene.vertices[scene.indices[surface.first_index + i]].atlas);
  ASSERT_EQ(places.size(), 12u);
  EXPECT_EQ(places[7], places[2]);
  EXPECT_EQ(places[9], places[5]);
}

TEST(SceneUnwrap, DoubleSidedSheetsBecomeTwoClosedBodiesStay) {
  auto builder = room();
  const int both = builder.material(glm::vec3(0.5f), glm::vec3(0), true);
  builder.quad("sheet", {glm::vec3{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, {0, 0, 1, 1}, both);
  builder.box("chest", {-1.5f, 0, -1.5f}, {-0.5f, 0.5f, -0.5f}, {0, 0, 1, 1}, both);
  forget_atlas(builder);
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  const auto triangles = [&](const std::string& node) {
    std::uint32_t count = 0;
    for (const auto& surface : scene.surfaces)
      if (surface.node == node) count += surface.index_count / 3;
    return count;
  };
  EXPECT_EQ(triangles("sheet"), 4u);
  EXPECT_EQ(triangles("chest"), 12u);
  EXPECT_EQ(scene.one_sided_indices, scene.indices.size());
  expect_good_atlas(scene);
}

TEST(SceneUnwrap, AClosedBodyThatHoldsSomethingIsSeenFromWithin) {
  SceneBuilder builder;
  const int both = builder.material(glm::vec3(0.5f), glm::vec3(0), true),
            lamp = builder.material({}, glm::vec3(5));
  builder.box("shell", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 1}, both);  // faces outwards
  builder.box("lamp", {-0.5f, 1, -0.5f}, {0.5f, 2, 0.5f}, {0, 0, 1, 1}, lamp);
  forget_atlas(builder);
  const Case of(builder);
  LogCapture log;
  EXPECT_EQ(of.loaded().indices.size(), 3u * (24 + 12));
}

TEST(SceneUnwrap, WhatRunsOverItselfIsCut) {
  // A ramp that winds up three times.
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  std::vector<glm::vec3> positions;
  std::vector<std::uint16_t> indices;
  constexpr std::uint16_t steps = 96;
  for (std::uint16_t i = 0; i <= steps; ++i) {
    const float angle = 6 * std::numbers::pi_v<float> * i / steps, height = 3.0f * i / steps;
    for (const float radius : {1.0f, 2.0f})
      positions.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    const auto a = static_cast<std::uint16_t>(2 * i);
    if (i < steps)
      for (const int corner : {0, 2, 1, 1, 2, 3}) indices.push_back(static_cast<std::uint16_t>(a + corner));
  }
  builder.mesh("ramp", positions, std::vector<glm::vec2>(positions.size()), indices, grey);
  forget_atlas(builder);
  const Case of(builder);
  LogCapture log;
  expect_good_atlas(of.loaded());
}

TEST(SceneUnwrap, TexturesKeepTheirCoordinates) {
  auto builder = room();
  auto& attributes = builder.primitive(2)["attributes"];
  attributes["TEXCOORD_1"] =
      builder.accessor(std::vector<glm::vec2>{{0, 0}, {7, 0}, {7, 7}, {0, 7}}, 5126, "VEC2");
  builder.gltf["images"] = {
      {{"uri",
        "data:image/"
        "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg="
        "="}}};
  builder.gltf["textures"] = {{{"source", 0}}};
  builder.gltf["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  std::vector<glm::vec2> colours;
  for (const auto& surface : scene.surfaces)
    if (surface.node == "lamp")
      for (std::uint32_t i = 0; i < surface.index_count; ++i)
        colours.push_back(scene.vertices[scene.indices[surface.first_index + i]].colour);
  EXPECT_THAT(colours, ::testing::Contains(glm::vec2(7, 7)));
  expect_good_atlas(scene);
}

TEST(SceneUnwrap, HiddenNodesTakeNoRoom) {
  auto builder = room();
  builder.gltf["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  LogCapture log;
  const Scene scene = Case(builder).loaded();
  EXPECT_THAT(log.take(), HasSubstr("unwrapped into 7 charts"));
  expect_good_atlas(scene);
}

TEST(SceneUnwrap, ANodeAsksForMoreTexels) {
  auto builder = room();
  builder.gltf["nodes"][1]["extras"]["texels"] = 3;
  const Case of(builder);
  LogCapture log;
  const Scene scene = of.loaded();
  const auto charts = charts_in(scene);
  double texels = 0, of_crate = 0, area = 0, area_of_crate = 0;
  const auto is_crate = [&](std::size_t t) {
    return std::ranges::any_of(scene.surfaces, [&](const Surface& surface) {
      return surface.node == "crate" && t >= surface.first_index / 3 &&
             t < (surface.first_index + surface.index_count) / 3;
    });
  };
  for (const auto& texel : valid_texels(scene, size)) (is_crate(texel.at.triangle) ? of_crate : texels) += 1;
  for (std::size_t t = 0; t < charts.size(); ++t) (is_crate(t) ? area_of_crate : area) += area_of(scene, t);
  EXPECT_NEAR(of_crate / area_of_crate, 9 * texels / area, 0.1 * 9 * texels / area);
  builder.gltf["nodes"][1]["extras"]["texels"] = "many";
  EXPECT_THROW(Case(builder).loaded(), SceneError);
}

TEST(SceneUnwrap, IsRefusedWhereItIsNotWanted) {
  const Case of(room());
  try {
    load(of.file, {.sky = {}, .lights = {}, .unwrap = {.keep_uv = true}});
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_THAT(e.what(), HasSubstr("node \"room\" and 2 more have no TEXCOORD_1: leave out --keep-uv"));
  }
}

TEST(SceneUnwrap, AnAtlasThatIsTooSmallIsDoubled) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  std::vector<glm::vec3> positions;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 1);
  for (int i = 0; i < 3 * 3000; ++i) positions.emplace_back(place(random), place(random), place(random));
  builder.mesh("soup", positions, std::vector<glm::vec2>(positions.size()), {}, grey);
  forget_atlas(builder);
  const Case of(builder);
  const auto unwrapped = of.unwrapped();
  EXPECT_EQ(unwrapped.size, 256u);
  EXPECT_EQ(unwrapped.charts, 3000u);
  LogCapture log;
  const Scene scene = of.loaded();
  check_atlas(scene, 256);
  EXPECT_THAT(log.take(), Not(HasSubstr("overlap")));
  // Nearly every triangle holds a texel's centre, however small.
  std::vector<bool> has_texel(3000);
  for (const auto& texel : valid_texels(scene, 256)) has_texel[texel.at.triangle] = true;
  EXPECT_GT(std::ranges::count(has_texel, true), 2850);
}

// Each pair fills the atlas: they are not all looked at, however many there are.
TEST(SceneUnwrap, ManyThatFillAnAtlasAreLaidAnew) {
  constexpr std::size_t copies = 30'000;
  LogCapture log;
  SceneBuilder builder;
  std::vector<std::uint16_t> indices;
  for (std::size_t copy = 0; copy < copies; ++copy) indices.insert(indices.end(), {0, 1, 2, 0, 2, 3});
  builder.mesh("pile", {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, indices,
               builder.material(glm::vec3(0.5f)));
  const Unwrapped unwrapped = Case(builder).unwrapped();
  EXPECT_THAT(unwrapped.reason, HasSubstr("triangles of node \"pile\" lie on many others in TEXCOORD_1"));
}

// An animation that no light is found by may claim any number of zeros.
TEST(SceneUnwrap, NoMoreIsWrittenThanCanBeRead) {
  SceneBuilder builder = room();
  builder.gltf["accessors"].push_back({{"componentType", 5126}, {"type", "VEC4"}, {"count", 1ull << 60}});
  const auto zeros = builder.gltf["accessors"].size() - 1;
  builder.gltf["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
       {"samplers", {{{"input", zeros}, {"output", zeros}}}}}};
  EXPECT_THAT([&] { Case(builder).unwrapped(); },
              ::testing::ThrowsMessage<SceneError>(HasSubstr("larger than 1 GiB")));
}

TEST(SceneUnwrap, AnythingEnds) {
  // Corners on few places: edges of many triangles, triangles without area, copies and their backs.
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1), true);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> place(0, 3);
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 3 * 500; ++i) positions.emplace_back(place(random), place(random), place(random));
  builder.mesh("knot", positions, std::vector<glm::vec2>(positions.size()), {}, grey);
  forget_atlas(builder);
  const Case of(builder);
  LogCapture log;
  expect_good_atlas(of.loaded(), 1);
}

}  // namespace
}  // namespace lichtveld::scene
