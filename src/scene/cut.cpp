#include "cut.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>

#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::size_t most_pieces = 200'000;
constexpr int most_cuts = 5;
// Samples along an edge of a piece that is looked at.
constexpr int samples = 8;
// A piece is even if its emission differs by less than this share of the material's, or its alpha by less than
// this.
constexpr float even = 0.05f;
// Emissions that are alike in so many steps of a channel are one material, of their mean.
constexpr float steps = 24;

struct Corner {
  Vertex vertex;
  glm::vec2 emission_at{0};
};

Corner between(const Corner& a, const Corner& b) {
  Corner result = a;
  result.vertex.position = (a.vertex.position + b.vertex.position) / 2.0f;
  const glm::vec3 normal = a.vertex.normal + b.vertex.normal;
  if (glm::length(normal) > 0) result.vertex.normal = glm::normalize(normal);
  result.vertex.atlas = (a.vertex.atlas + b.vertex.atlas) / 2.0f;
  result.vertex.colour = (a.vertex.colour + b.vertex.colour) / 2.0f;
  result.vertex.tint = glm::u16vec4((glm::uvec4(a.vertex.tint) + glm::uvec4(b.vertex.tint)) / 2u);
  result.emission_at = (a.emission_at + b.emission_at) / 2.0f;
  return result;
}

// The mean of what is sampled, and how far samples are from each other.
struct Range {
  glm::vec3 sum{0}, low{1e30f}, high{-1e30f};
  int count = 0;

  void add(const glm::vec3& value) {
    sum += value;
    low = glm::min(low, value);
    high = glm::max(high, value);
    ++count;
  }
  glm::vec3 mean() const { return sum / static_cast<float>(count); }
  bool is_even() const { return glm::all(glm::lessThanEqual(high - low, glm::vec3(even))); }
};

class Cutter {
 public:
  Cutter(const Material& material, const Uneven& uneven, const std::vector<Texture>& textures,
         std::vector<Vertex>& vertices)
      : material_(material), uneven_(uneven), textures_(textures), vertices_(vertices) {}

  void take(const std::array<Corner, 3>& corners, const std::array<std::uint32_t, 3>& indices, int times) {
    if (!divide(corners, times)) keep(indices);
  }

  std::vector<Cut> finish() {
    std::vector<Cut> cuts;
    for (auto& [key, of] : classes_) {
      Cut cut{material_, std::move(of.indices)};
      cut.material.emission *= of.emission / std::max(of.area, 1e-30f);
      // What stands for a pane's reflection is fewer pieces than it has: they reflect as much more.
      if (of.there > 0) cut.material.base_colour *= std::min(of.reflects / of.there, 1.0f);
      cuts.push_back(std::move(cut));
    }
    return cuts;
  }

 private:
  struct Class {
    std::vector<std::uint32_t> indices;
    glm::vec3 emission{0};
    float area = 0, there = 0, reflects = 0;
  };

  struct Look {
    Range emission, there;  // of `there` all three are alike
    float reflects = 0;     // the share of a pane that reflects its base colour
  };

  // What samples of a triangle show.
  Look look(const std::array<Corner, 3>& corners) const {
    Look result;
    for (int i = 0; i < samples; ++i)
      for (int j = 0; i + j < samples; ++j) {
        const float step = 1.0f / samples, b = (static_cast<float>(i) + 1 / 3.0f) * step,
                    c = (static_cast<float>(j) + 1 / 3.0f) * step, a = 1 - b - c;
        const auto mix = [&](auto of) { return a * of(corners[0]) + b * of(corners[1]) + c * of(corners[2]); };
        if (uneven_.emission >= 0)
          result.emission.add(sample_srgb(textures_[static_cast<std::size_t>(uneven_.emission)],
                                          mix([](const Corner& corner) { return corner.emission_at; }),
                                          uneven_.wrap));
        else
          result.emission.add(glm::vec3(1));
        const glm::vec4 tint =
            mix([](const Corner& corner) { return glm::vec4(glm::unpackUnorm<float>(corner.vertex.tint)); });
        glm::vec4 base(material_.base_colour * glm::vec3(tint), uneven_.alpha_factor * tint.a);
        if (material_.texture >= 0) {
          const auto& texture = textures_[static_cast<std::size_t>(material_.texture)];
          const glm::vec2 at = mix([](const Corner& corner) { return corner.vertex.colour; });
          base *=
              glm::vec4(sample_srgb(texture, at, material_.wrap), sample_alpha(texture, at, material_.wrap));
        }
        const float alpha = uneven_.alpha == Uneven::Alpha::opaque ? 1
                            : uneven_.alpha == Uneven::Alpha::mask ? (base.a >= uneven_.cutoff ? 1.0f : 0.0f)
                                                                   : std::clamp(base.a, 0.0f, 1.0f);
        const float through = uneven_.transmission * (base.r + base.g + base.b) / 3;
        result.there.add(glm::vec3(alpha * (1 - through)));
        result.reflects += alpha * (1 - uneven_.transmission);
      }
    result.reflects /= static_cast<float>(result.there.count);
    return result;
  }

  // Cuts a triangle; false where it is to be kept whole as it is.
  bool divide(const std::array<Corner, 3>& corners, int times) {
    const Look seen = look(corners);
    const float there = seen.there.mean().x;
    const bool settled = seen.there.is_even() && (there <= even || there >= 1 - even);
    if (times == 0 || (settled && seen.emission.is_even())) {
      // Rounded so that the sum over pieces is right.
      owed_ += settled ? std::round(there) : there;
      if (owed_ < 0.5f) return true;
      owed_ -= 1;
      class_of_ = key_of(seen.emission.mean());
      Class& of = classes_[class_of_];
      const float area = glm::length(glm::cross(corners[1].vertex.position - corners[0].vertex.position,
                                                corners[2].vertex.position - corners[0].vertex.position));
      of.emission += area * seen.emission.mean();
      of.area += area;
      of.there += there;
      of.reflects += seen.reflects;
      return false;
    }
    const Corner ab = between(corners[0], corners[1]), bc = between(corners[1], corners[2]),
                 ca = between(corners[2], corners[0]);
    for (const auto& piece : {std::array{corners[0], ab, ca}, std::array{ab, corners[1], bc},
                              std::array{ca, bc, corners[2]}, std::array{ab, bc, ca}})
      if (!divide(piece, times - 1)) {
        std::array<std::uint32_t, 3> indices;
        for (std::size_t k = 0; k < 3; ++k) {
          indices[k] = static_cast<std::uint32_t>(vertices_.size());
          vertices_.push_back(piece[k].vertex);
        }
        keep(indices);
      }
    return true;
  }

  void keep(const std::array<std::uint32_t, 3>& indices) {
    auto& to = classes_[class_of_].indices;
    to.insert(to.end(), indices.begin(), indices.end());
  }

  using Key = std::array<int, 3>;
  static Key key_of(const glm::vec3& emission) {
    Key key;
    for (int c = 0; c < 3; ++c)
      key[static_cast<std::size_t>(c)] = static_cast<int>(std::lround(std::sqrt(emission[c]) * steps));
    return key;
  }

  const Material& material_;
  const Uneven& uneven_;
  const std::vector<Texture>& textures_;
  std::vector<Vertex>& vertices_;
  std::map<Key, Class> classes_;
  Key class_of_{};
  float owed_ = 0;
};

}  // namespace

int cuts_for(std::size_t triangles) {
  int times = 0;
  for (std::size_t pieces = triangles; times < most_cuts && pieces * 4 <= most_pieces; pieces *= 4) ++times;
  return times;
}

std::vector<Cut> cut(const Material& material, const Uneven& uneven, const std::vector<std::uint32_t>& indices,
                     const std::vector<glm::vec2>& emission_at, std::uint32_t first, int times,
                     const std::vector<Texture>& textures, std::vector<Vertex>& vertices) {
  Cutter cutter(material, uneven, textures, vertices);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t index = indices[i + k];
      corners[k] = {vertices[index], emission_at.empty() ? glm::vec2(0) : emission_at[index - first]};
    }
    cutter.take(corners, {indices[i], indices[i + 1], indices[i + 2]}, times);
  }
  return cutter.finish();
}

}  // namespace lichtveld::scene
