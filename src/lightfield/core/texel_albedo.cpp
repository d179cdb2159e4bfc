#include "core/texel_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

// Places in a texel that are looked at: many where it holds many pixels of the texture, whose steps could
// otherwise fall in with the texels'.
constexpr std::uint32_t few = 16, many = 64;
constexpr double pixels_of_few = 4;

constexpr std::uint32_t rows_of_a_task = 16;

// Points in the unit square of which any run in order is spread evenly (Roberts 2018, the R2 sequence).
glm::dvec2 spread(std::uint64_t number) {
  const auto turn = [&](double step) {
    const double at = 0.5 + step * static_cast<double>(number);
    return at - std::floor(at);
  };
  return {turn(0.7548776662466927), turn(0.5698402909980532)};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

const scene::Material& material_of(const scene::Scene& scene, std::uint32_t surface) {
  return scene.materials[scene.surfaces[surface].material];
}

// Whether a surface has one colour everywhere.
bool is_even(const scene::Scene& scene, std::uint32_t number) {
  const auto& surface = scene.surfaces[number];
  const auto indices = std::span(scene.indices).subspan(surface.first_index, surface.index_count);
  const auto tint = [&](std::uint32_t index) { return scene.vertices[index].tint; };
  return material_of(scene, number).texture < 0 &&
         std::ranges::all_of(indices, [&](std::uint32_t index) { return tint(index) == tint(indices[0]); });
}

// A triangle's chart, in texels.
class Chart {
 public:
  Chart(const scene::Scene& scene, const scene::Material& material, std::uint32_t triangle, std::uint32_t size)
      : triangle_(triangle) {
    std::array<glm::dvec2, 3> at, pixel;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = scene.vertices[scene.indices[std::size_t{3} * triangle + k]];
      at[k] = glm::dvec2(vertex.atlas) * static_cast<double>(size);
      pixel[k] = vertex.colour;
    }
    origin_ = at[0], u_ = at[1] - at[0], v_ = at[2] - at[0];
    min_ = glm::min(glm::min(at[0], at[1]), at[2]);
    max_ = glm::max(glm::max(at[0], at[1]), at[2]);
    area_ = cross(u_, v_);
    if (material.texture < 0) return;
    const auto& texture = scene.textures[static_cast<std::size_t>(material.texture)];
    pixels_ =
        std::abs(cross(pixel[1] - pixel[0], pixel[2] - pixel[0]) / area_) * texture.width * texture.height;
  }

  bool has_area() const { return area_ != 0; }
  std::uint32_t points() const { return pixels_ > pixels_of_few ? many : few; }

  // Calls each(x, y) of the texels of rows first .. end - 1 that it may touch.
  template <typename Each>
  void for_texels(std::uint32_t first, std::uint32_t end, std::uint32_t size, const Each& each) const {
    const auto begin_of = [](double low, double least, double most) {
      return static_cast<std::uint32_t>(std::clamp(std::floor(low), least, most));
    };
    const auto left = begin_of(min_.x, 0, size), right = begin_of(max_.x + 1, 0, size),
               top = begin_of(min_.y, first, end), bottom = begin_of(max_.y + 1, first, end);
    for (auto y = top; y < bottom; ++y)
      for (auto x = left; x < right; ++x) each(x, y);
  }

  // The surface there, if it is of this triangle.
  std::optional<scene::SurfacePoint> find(const glm::dvec2& at) const {
    const glm::dvec2 from = at - origin_;
    const double b = cross(from, v_) / area_, c = cross(u_, from) / area_;
    if (b < 0 || c < 0 || b + c > 1) return std::nullopt;
    return scene::SurfacePoint{triangle_, glm::vec2(b, c)};
  }

 private:
  std::uint32_t triangle_;
  glm::dvec2 origin_{0}, u_{0}, v_{0}, min_{0}, max_{0};
  double area_ = 0;    // twice, signed [texels]
  double pixels_ = 0;  // of its texture in a texel
};

}  // namespace

void average_albedo(const scene::Scene& scene, std::uint32_t size, std::vector<TexelRecord>& records) {
  std::vector<std::uint32_t> at(std::size_t{size} * size, no_record);
  for (std::uint32_t number = 0; number < records.size(); ++number) at[records[number].atlas] = number;
  std::vector<char> even;
  for (std::uint32_t number = 0; number < scene.surfaces.size(); ++number)
    even.push_back(is_even(scene, number));
  const auto average_rows = [&](std::uint32_t first, std::uint32_t end) {
    std::vector<glm::vec4> sums(std::size_t{end - first} * size, glm::vec4(0));
    for (std::uint32_t number = 0; number < scene.surfaces.size(); ++number) {
      if (even[number]) continue;
      const auto& surface = scene.surfaces[number];
      const auto& material = material_of(scene, number);
      for (auto index = surface.first_index; index < surface.first_index + surface.index_count; index += 3) {
        const Chart chart(scene, material, index / 3, size);
        if (!chart.has_area()) continue;
        chart.for_texels(first, end, size, [&](std::uint32_t x, std::uint32_t y) {
          const auto record = at[std::size_t{y} * size + x];
          if (record == no_record || records[record].surface != number) return;
          for (std::uint32_t i = 0; i < chart.points(); ++i) {
            const auto place = spread((std::uint64_t{y} * size + x) * many + i);
            if (const auto point = chart.find(glm::dvec2(x, y) + place))
              sums[std::size_t{y - first} * size + x] +=
                  glm::vec4(scene::albedo_at(scene, material, *point), 1) *
                  (1.0f / static_cast<float>(chart.points()));
          }
        });
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (sums[i].a > 0) records[at[std::size_t{first} * size + i]].albedo = glm::vec3(sums[i]) / sums[i].a;
  };
  const auto tasks = (size + rows_of_a_task - 1) / rows_of_a_task;
  for_each_index(0, tasks, 1, [&](std::uint32_t task) {
    average_rows(task * rows_of_a_task, std::min((task + 1) * rows_of_a_task, size));
  });
}

glm::vec3 mean_albedo(const scene::Scene& scene, std::uint32_t surface, std::uint32_t triangle) {
  const auto& material = material_of(scene, surface);
  if (material.texture < 0) return scene::albedo_at(scene, material, {triangle, glm::vec2(1.0f / 3)});
  glm::vec3 sum(0);
  for (std::uint32_t i = 0; i < few; ++i) {
    glm::vec2 at = spread(i);
    if (at.x + at.y > 1) at = 1.0f - at;
    sum += scene::albedo_at(scene, material, {triangle, at});
  }
  return sum / float{few};
}

}  // namespace lichtveld::lightfield
