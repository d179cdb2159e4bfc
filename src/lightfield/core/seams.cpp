#include "core/seams.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lichtveld/scene/seams.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr float places_a_texel = 2;
// No more places than so many for each texel of the atlas: charts that lie on each other can have any number.
constexpr std::size_t most_places = 8;
// What a texel's shift weighs against a disagreement: of a step at a seam a hundredth stays.
constexpr float shift_weight = 0.02f;
constexpr float least_tap = 1e-3f;
// A texel that is read at a seam is there if it is no farther from it [sides] and looks the same way; others
// are of a chart that happens to lie near in the atlas.
constexpr float most_apart = 3, alike_cosine = 0.7f;

struct AtlasTap {
  std::uint32_t texel;
  float weight;
};

// What bilinear filtering reads at a place of a triangle.
class Filter {
 public:
  Filter(const scene::Scene& scene, const TexelRecords& records)
      : scene_(scene), records_(records), surfaces_(surface_of_triangles(scene)) {}

  // False where some of it is not there.
  bool add(std::uint32_t triangle, const glm::vec2& at, const glm::vec3& position, float sign,
           std::vector<AtlasTap>& taps) const {
    const auto size = static_cast<int>(records_.size());
    const glm::vec2 place = at * static_cast<float>(size) - 0.5f, low = glm::floor(place), share = place - low;
    const glm::vec3 face = scene::facing_of(scene_, triangle).face;
    for (int corner = 0; corner < 4; ++corner) {
      const int right = corner & 1, down = corner >> 1;
      const float weight = (right ? share.x : 1 - share.x) * (down ? share.y : 1 - share.y);
      if (weight < least_tap) continue;
      const int x = std::clamp(static_cast<int>(low.x) + right, 0, size - 1),
                y = std::clamp(static_cast<int>(low.y) + down, 0, size - 1);
      const auto texel = static_cast<std::uint32_t>(y * size + x), source = records_.source()[texel];
      if (source == no_record || !is_there(records_[source], triangle, face, position)) return false;
      taps.push_back({texel, sign * weight});
    }
    return true;
  }

 private:
  bool is_there(const TexelRecord& record, std::uint32_t triangle, const glm::vec3& face,
                const glm::vec3& position) const {
    return record.surface == surfaces_[triangle] && glm::dot(record.face, face) >= alike_cosine &&
           glm::distance(record.position, position) <= most_apart * record.side;
  }

  const scene::Scene& scene_;
  const TexelRecords& records_;
  std::vector<std::uint32_t> surfaces_;
};

float longest(const scene::Seam& seam) {
  return std::max(glm::distance(seam.sides[0].from, seam.sides[0].to),
                  glm::distance(seam.sides[1].from, seam.sides[1].to));
}

}  // namespace

struct Seams::Factored {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<float>> matrix;
};

Seams::~Seams() = default;

Seams::Seams(const scene::Scene& scene, const TexelRecords& records) {
  const Filter filter(scene, records);
  std::vector<std::uint32_t> numbers(records.source().size(), no_record);
  const auto number = [&](std::uint32_t texel) {
    if (numbers[texel] == no_record) {
      numbers[texel] = static_cast<std::uint32_t>(texels_.size());
      texels_.push_back(texel);
      const auto& source = records[records.source()[texel]];
      shows_.push_back({source.atlas, source.albedo / std::numbers::pi_v<float>});
    }
    return numbers[texel];
  };
  // Edges far shorter than a texel take turns.
  float owed = 0;
  std::vector<AtlasTap> taps;
  for (const auto& seam : scene::find_seams(scene)) {
    owed += longest(seam) * static_cast<float>(records.size()) * places_a_texel;
    const float count = std::floor(owed);
    owed -= count;
    if (ends_.size() > most_places * records.source().size()) break;
    for (float place = 0.5f; place < count; ++place) {
      taps.clear();
      const auto on = [&](std::size_t side, float sign) {
        const auto& [triangle, from, to] = seam.sides[side];
        return filter.add(triangle, glm::mix(from, to, place / count),
                          glm::mix(seam.from, seam.to, place / count), sign, taps);
      };
      if (!on(0, 1) || !on(1, -1)) continue;
      for (const auto& tap : taps) taps_.push_back({number(tap.texel), tap.weight});
      ends_.push_back(static_cast<std::uint32_t>(taps_.size()));
    }
  }
  if (texels_.empty()) return;
  std::vector<Eigen::Triplet<float>> entries;
  for (std::uint32_t place = 0, first = 0; place < ends_.size(); first = ends_[place++])
    for (auto i = first; i < ends_[place]; ++i)
      for (auto j = first; j < ends_[place]; ++j)
        entries.emplace_back(static_cast<int>(taps_[i].texel), static_cast<int>(taps_[j].texel),
                             taps_[i].weight * taps_[j].weight);
  const auto count = static_cast<int>(texels_.size());
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, shift_weight);
  Eigen::SparseMatrix<float> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  auto factored = std::make_unique<Factored>();
  factored->matrix.compute(matrix);
  factored_ = std::move(factored);
}

std::vector<glm::vec3> Seams::offsets(std::span<const glm::vec4> irradiance) const {
  if (texels_.empty()) return {};
  Eigen::MatrixX3f wanted = Eigen::MatrixX3f::Zero(static_cast<Eigen::Index>(texels_.size()), 3);
  for (std::uint32_t place = 0, first = 0; place < ends_.size(); first = ends_[place++]) {
    glm::vec3 apart(0);
    bool lit = true;
    for (auto i = first; i < ends_[place]; ++i) {
      const glm::vec3 light(irradiance[shows_[taps_[i].texel].texel]);
      lit = lit && light != glm::vec3(0);
      apart += taps_[i].weight * light;
    }
    if (!lit) continue;
    for (auto i = first; i < ends_[place]; ++i)
      for (int channel = 0; channel < 3; ++channel)
        wanted(taps_[i].texel, channel) -= taps_[i].weight * apart[channel];
  }
  const Eigen::MatrixX3f shifts = factored_->matrix.solve(wanted);
  std::vector<glm::vec3> offsets;
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    offsets.push_back(shows_[i].reflected * glm::vec3(shifts(row, 0), shifts(row, 1), shifts(row, 2)));
  }
  return offsets;
}

}  // namespace lichtveld::lightfield
