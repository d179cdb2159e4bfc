// The direction sets and their views.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/psf_view.hpp"
#include "lichtveld/lightfield/directions.hpp"

namespace lichtveld::lightfield {
namespace {

using ::testing::HasSubstr;

class SetOfDirections : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(SetOfDirections, CoversTheSphereOnce) {
  const auto set = DirectionSet(GetParam());
  ASSERT_EQ(set.size(), GetParam());
  double sum = 0, smallest = 100, largest = 0;
  glm::dvec3 mean(0);
  for (const auto& direction : set) {
    EXPECT_NEAR(glm::length(direction.along), 1, 1e-6);
    sum += direction.solid_angle;
    mean += glm::dvec3(direction.along) * double{direction.solid_angle};
    smallest = std::min<double>(smallest, direction.solid_angle);
    largest = std::max<double>(largest, direction.solid_angle);
  }
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-4);
  EXPECT_LT(glm::length(mean), 1e-5);
  EXPECT_LT(largest / smallest, 6);  // the octahedron's faces are larger at their middles
}

TEST_P(SetOfDirections, HasExactAntipodes) {
  const auto set = DirectionSet(GetParam());
  for (std::size_t index = 0; index < set.size() / 2; ++index) {
    EXPECT_EQ(set[index].along, -set[set.size() / 2 + index].along);
    EXPECT_EQ(set[index].solid_angle, set[set.size() / 2 + index].solid_angle);
  }
}

// E of a uniform sky is pi: the weights integrate the cosine. The error falls with the count.
TEST_P(SetOfDirections, IntegratesACosine) {
  for (const glm::vec3 normal : {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, 2, 3)), glm::vec3(0, 1, 0)}) {
    double sum = 0;
    for (const auto& direction : DirectionSet(GetParam()))
      sum += std::max(0.0f, -glm::dot(normal, direction.along)) * direction.solid_angle;
    EXPECT_NEAR(sum, std::numbers::pi, 3.0 / std::sqrt(GetParam()));
  }
}

// Each half is a set of its own, so that either's answer is one.
TEST_P(SetOfDirections, HasTwoHalvesThatCoverTheSphereEach) {
  std::array<std::uint32_t, 2> counts{};
  std::array<double, 2> sums{};
  for (const auto& direction : DirectionSet(GetParam())) {
    ++counts.at(direction.half);
    sums.at(direction.half) += direction.solid_angle;
  }
  for (const int half : {0, 1}) {
    EXPECT_EQ(counts[half], GetParam() / 2);
    EXPECT_NEAR(sums[half], 2 * std::numbers::pi, 1e-4);
  }
}

// The halves have the same cells in the same order: turned alike, they would have the same directions.
TEST_P(SetOfDirections, TurnsItsHalvesApart) {
  const auto set = DirectionSet(GetParam());
  const std::size_t cells = GetParam() / 4;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    EXPECT_EQ(set[cell].half, 0u);
    EXPECT_EQ(set[cells + cell].half, 1u);
    EXPECT_EQ(set[cell].solid_angle, set[cells + cell].solid_angle);
    EXPECT_GT(glm::distance(set[cell].along, set[cells + cell].along), 1e-3);
    EXPECT_NE(set[cell].roll, set[cells + cell].roll);
    EXPECT_NE(set[cell].jitter, set[cells + cell].jitter);
  }
}

TEST_P(SetOfDirections, DependsOnTheSeedAlone) {
  const auto set = DirectionSet(GetParam(), Weights::solid_angle, 7),
             again = DirectionSet(GetParam(), Weights::solid_angle, 7),
             other = DirectionSet(GetParam(), Weights::solid_angle, 8);
  for (std::size_t index = 0; index < set.size(); ++index) {
    EXPECT_EQ(set[index].along, again[index].along);
    EXPECT_EQ(set[index].roll, again[index].roll);
    EXPECT_EQ(set[index].jitter, again[index].jitter);
    EXPECT_GT(glm::distance(set[index].along, other[index].along), 1e-3);
    EXPECT_NE(set[index].roll, other[index].roll);
    EXPECT_EQ(set[index].solid_angle, other[index].solid_angle);
  }
}

TEST_P(SetOfDirections, EqualWeightsAreOneShareEach) {
  for (const auto& direction : DirectionSet(GetParam(), Weights::equal))
    EXPECT_FLOAT_EQ(direction.solid_angle, static_cast<float>(4 * std::numbers::pi / GetParam()));
}

// Whoever takes a range of the pairs, or a part, or a half: together they are the set, each pair once.
TEST_P(SetOfDirections, PairsStandHalfByHalfAndPartByPart) {
  const DirectionSet set(GetParam());
  const auto pairs = set.pairs();
  ASSERT_EQ(pairs.size(), set.size() / 2);
  EXPECT_EQ(set.half(0), (Range{0, set.size() / 4}));
  EXPECT_EQ(set.half(1), (Range{set.size() / 4, set.size() / 2}));
  std::uint32_t end = 0;
  for (std::uint32_t part = 0; part < DirectionSet::parts; ++part) {
    const auto range = set.part(part);
    EXPECT_EQ(range.first, end);
    EXPECT_EQ(range.first % 2, 0u) << "two links share a word of the table";
    end = range.end;
    for (auto pair = range.first; pair < range.end; ++pair)
      EXPECT_EQ(pairs[pair].half, part < DirectionSet::parts / 2 ? 0u : 1u);
  }
  EXPECT_EQ(end, pairs.size());
  double sum = 0;
  for (const auto& pair : pairs) {
    sum += 2 * pair.solid_angle;
    EXPECT_TRUE(std::ranges::any_of(set, [&](const Direction& one) { return one.along == pair.along; }));
  }
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(All, SetOfDirections,
                         ::testing::ValuesIn(direction_counts().begin(), direction_counts().end()));

TEST(Directions, OtherCountsAreRefusedWithTheList) {
  for (const std::uint32_t count : {0u, 1u, 25u, 385u, 8192u}) {
    try {
      DirectionSet{count};
      FAIL() << count << " was taken";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("8, 24, 32, 96, 128, 384, 512, 1536, 2048, 6144"));
    }
  }
}

TEST(PsfView, IsOrthonormalAndFitsTheSphereWhateverTheJitter) {
  const scene::Sphere sphere{{3, -2, 5}, 4};
  constexpr std::uint32_t pixels = 64;
  const float length = (1 - 1.0f / pixels) / sphere.radius;  // room for the jitter of half a pixel
  for (const auto& direction : DirectionSet(96)) {
    const auto view = psf_view(direction, sphere, pixels);
    const glm::vec3 right = glm::vec3(view.right) / length, up = glm::vec3(view.up) / length,
                    along = glm::vec3(view.along) / length;
    EXPECT_LT(glm::distance(along, direction.along), 1e-6);
    EXPECT_LT(glm::distance(glm::cross(right, up), along), 1e-5);
    EXPECT_NEAR(glm::dot(view.along, glm::vec4(sphere.centre, 1)), 0, 1e-6);
    for (const float side : {-1.0f, 1.0f})
      for (const auto& [row, axis] : {std::pair{view.right, right}, std::pair{view.up, up}})
        EXPECT_LE(std::abs(glm::dot(row, glm::vec4(sphere.centre + side * sphere.radius * axis, 1))), 1 + 1e-6);
    const glm::vec2 shift(glm::dot(view.right, glm::vec4(sphere.centre, 1)),
                          glm::dot(view.up, glm::vec4(sphere.centre, 1)));
    EXPECT_LT(glm::distance(shift, direction.jitter * (2.0f / pixels)), 1e-6);
  }
}

}  // namespace
}  // namespace lichtveld::lightfield
