#include "sky.hpp"

#include <OpenImageIO/imageio.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <numeric>
#include <sstream>

#include "exr_header.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 27;  // 16384 x 8192
constexpr std::uint32_t most_columns = 1024;                   // that are kept: a third of a degree each
constexpr std::uint32_t harmonic_columns = 128;
constexpr float brightest = 1e6f;
constexpr const char* openexr = "openexr";  // as OpenImageIO calls it

// A sun is brighter than `sun_contrast` times what all but a twentieth of the sky is, no larger than 9 degrees
// across, and brings a hundredth of all light or more.
constexpr float sun_contrast = 20, dim_share = 0.95f, largest_sun = 0.02f, least_share = 0.01f;
constexpr std::size_t most_suns = 8;

float luminance(const glm::vec3& colour) {
  return 0.2126f * colour.r + 0.7152f * colour.g + 0.0722f * colour.b;
}

Sky empty_sky(std::uint32_t width, std::uint32_t height) {
  return {.width = width,
          .height = height,
          .radiance = std::vector<glm::vec3>(std::size_t{width} * height, glm::vec3(0))};
}

glm::vec3 checked(const glm::dvec3& radiance, const std::string& what) {
  for (int channel = 0; channel < 3; ++channel)
    if (!(radiance[channel] >= 0 && radiance[channel] <= brightest))
      throw SceneError(what + ": radiance must be 0..1e6 in each channel");
  return radiance;
}

FoundSky even_sky(const glm::dvec3& radiance, const std::string& what) {
  return {.sky = {.radiance = {checked(radiance, what)}}, .suns = {}};
}

// The radiance of which `share` of the sky is no brighter.
float quantile(const Sky& sky, float share) {
  std::vector<std::uint32_t> order(sky.radiance.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t pixel) { return luminance(sky.radiance[pixel]); });
  double below = 0;
  for (const auto pixel : order)
    if ((below += solid_angle_of(sky, pixel / sky.width)) >= share * 4 * std::numbers::pi)
      return luminance(sky.radiance[pixel]);
  return luminance(sky.radiance[order.back()]);
}

// Pixels beside one: across the seam, too.
std::array<std::uint32_t, 4> neighbours(const Sky& sky, std::uint32_t pixel) {
  const std::uint32_t row = pixel / sky.width, column = pixel % sky.width;
  return {row * sky.width + (column + 1) % sky.width, row * sky.width + (column + sky.width - 1) % sky.width,
          row > 0 ? pixel - sky.width : pixel, row + 1 < sky.height ? pixel + sky.width : pixel};
}

// Bright pixels that hang together.
struct Spot {
  std::vector<std::uint32_t> pixels = {};
  double solid_angle = 0, flux = 0, squared = 0;  // [sr], and of luminance once and squared over it
};

std::vector<Spot> bright_spots(const Sky& sky, float threshold) {
  std::vector<Spot> spots;
  std::vector<bool> reached(sky.radiance.size());
  for (std::uint32_t first = 0; first < sky.radiance.size(); ++first) {
    if (reached[first] || !(luminance(sky.radiance[first]) > threshold)) continue;
    Spot& spot = spots.emplace_back();
    spot.pixels.push_back(first);
    reached[first] = true;
    for (std::size_t next = 0; next < spot.pixels.size(); ++next) {
      const auto pixel = spot.pixels[next];
      const double share = solid_angle_of(sky, pixel / sky.width), light = luminance(sky.radiance[pixel]);
      spot.solid_angle += share, spot.flux += share * light, spot.squared += share * light * light;
      for (const auto beside : neighbours(sky, pixel))
        if (!reached[beside] && luminance(sky.radiance[beside]) > threshold) {
          reached[beside] = true;
          spot.pixels.push_back(beside);
        }
    }
  }
  return spots;
}

// Takes a spot out of the sky, which is there as what is around it.
PunctualLight sun_of(Sky& sky, const Spot& spot) {
  glm::dvec3 around(0);
  double count = 0;
  std::vector<std::uint32_t> sorted = spot.pixels;
  std::ranges::sort(sorted);
  for (const auto pixel : spot.pixels)
    for (const auto beside : neighbours(sky, pixel))
      if (!std::ranges::binary_search(sorted, beside)) around += sky.radiance[beside], ++count;
  const glm::vec3 rest = count > 0 ? around / count : glm::dvec3(0);
  glm::dvec3 intensity(0), towards(0);
  for (const auto pixel : spot.pixels) {
    const std::uint32_t row = pixel / sky.width;
    const double share = solid_angle_of(sky, row);
    auto& radiance = sky.radiance[pixel];
    intensity += share * glm::dvec3(radiance - rest);
    towards += share * luminance(radiance) * glm::dvec3(direction_of(sky, pixel % sky.width, row));
    radiance = rest;
  }
  // As large as a disc of one radiance that is as bright as it is.
  const double disc = std::min(spot.flux * spot.flux / spot.squared, spot.solid_angle);
  PunctualLight sun{.node = sky_name,
                    .kind = PunctualLight::Kind::directional,
                    .intensity = glm::max(glm::vec3(intensity), 0.0f)};
  sun.direction = -glm::normalize(glm::vec3(towards));
  sun.angle = static_cast<float>(glm::degrees(2 * std::acos(1 - disc / (2 * std::numbers::pi))));
  return sun;
}

std::vector<PunctualLight> take_out_suns(Sky& sky) {
  const float threshold = sun_contrast * quantile(sky, dim_share);
  double all = 0;
  for (std::uint32_t pixel = 0; pixel < sky.radiance.size(); ++pixel)
    all += double{solid_angle_of(sky, pixel / sky.width)} * luminance(sky.radiance[pixel]);
  auto spots = bright_spots(sky, threshold);
  std::erase_if(
      spots, [&](const Spot& spot) { return spot.solid_angle > largest_sun || spot.flux < least_share * all; });
  std::ranges::stable_sort(spots, std::greater(), &Spot::flux);
  std::vector<PunctualLight> suns;
  for (std::size_t i = 0; i < std::min(spots.size(), most_suns); ++i) suns.push_back(sun_of(sky, spots[i]));
  return suns;
}

// By its first bytes, so that no other reader than that one is tried.
const char* format_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> start{};
  if (!in.read(start.data(), start.size()))
    throw SceneError("sky " + file.string() + ": it cannot be read; give a .hdr, a .exr or R,G,B");
  if (start[0] == '#' && start[1] == '?') return "hdr";
  if (start == std::array<char, 4>{0x76, 0x2f, 0x31, 0x01}) return openexr;
  throw SceneError("sky " + file.string() + ": it is neither Radiance .hdr nor OpenEXR");
}

// Boxes of pixels of the picture, row by row.
Sky read_picture(const fs::path& file) {
  const std::string what = "sky " + file.string();
  const std::string format = format_of(file);
  if (format == openexr) check_exr_header(file, what);
  const auto input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!input || !input->open(file.string(), spec)) {
    const std::string reason = input ? input->geterror() : "OpenImageIO has no reader for it";
    throw SceneError(what + " does not decode: " + reason);
  }
  const auto columns = static_cast<std::uint32_t>(std::max(spec.width, 0)),
             rows = static_cast<std::uint32_t>(std::max(spec.height, 0));
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows) + " pixels";
  if (spec.nchannels < 3) throw SceneError(what + " has less than three channels");
  if (std::uint64_t{columns} * rows > most_pixels)
    throw SceneError(what + " has " + size + ": 16384 x 8192 are read; scale it down");
  if (rows < 1 || columns != 2 * rows)
    throw SceneError(what + " has " + size + ": an equirectangular picture is twice as wide as it is high");
  Sky sky = empty_sky(std::min(columns, most_columns), std::min(rows, most_columns / 2));
  std::vector<float> counts(sky.radiance.size(), 0), row(std::size_t{columns} * 3);
  std::size_t odd = 0;
  for (std::uint32_t y = 0; y < rows; ++y) {
    const int at = spec.y + static_cast<int>(y);
    if (!input->read_scanlines(0, 0, at, at + 1, 0, 0, 3, OIIO::TypeDesc::FLOAT, row.data())) {
      const std::string reason = input->geterror();
      throw SceneError(what + " does not decode: " + reason);
    }
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::size_t pixel =
          std::size_t{y} * sky.height / rows * sky.width + std::size_t{x} * sky.width / columns;
      glm::vec3 radiance(row[std::size_t{3} * x], row[std::size_t{3} * x + 1], row[std::size_t{3} * x + 2]);
      for (int channel = 0; channel < 3; ++channel)
        if (!(radiance[channel] >= 0 && radiance[channel] <= brightest)) {
          radiance[channel] = radiance[channel] > brightest ? brightest : 0;
          ++odd;
        }
      sky.radiance[pixel] += radiance;
      ++counts[pixel];
    }
  }
  for (std::size_t pixel = 0; pixel < counts.size(); ++pixel) sky.radiance[pixel] /= counts[pixel];
  if (odd > 0)
    spdlog::warn("{}: {} values are no radiance of 0..1e6, and are taken for its nearest", what, odd);
  return sky;
}

FoundSky sky_of_file(const fs::path& file) {
  FoundSky found{.sky = read_picture(file), .suns = {}};
  found.suns = take_out_suns(found.sky);
  return found;
}

// Real spherical harmonics up to the second degree, in the usual order.
std::array<double, 9> harmonics(const glm::dvec3& d) {
  return {0.282095,
          0.488603 * d.y,
          0.488603 * d.z,
          0.488603 * d.x,
          1.092548 * d.x * d.y,
          1.092548 * d.y * d.z,
          0.315392 * (3 * d.z * d.z - 1),
          1.092548 * d.x * d.z,
          0.546274 * (d.x * d.x - d.y * d.y)};
}

double number(const tinygltf::Value& value, const std::string& what) {
  if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble())) throw SceneError(what + " is no number");
  return value.GetNumberAsDouble();
}

// The radiance whose irradiance has these coefficients (Ramamoorthi and Hanrahan 2001, "An Efficient
// Representation for Irradiance Environment Maps", equation 8), where that is not below 0.
FoundSky sky_of_harmonics(const tinygltf::Value& light, const std::string& what) {
  constexpr double pi = std::numbers::pi;
  constexpr std::array<double, 9> shares = {pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                            pi / 4, pi / 4,     pi / 4,     pi / 4};
  const double intensity = light.Has("intensity") ? number(light.Get("intensity"), what + ": intensity") : 1;
  glm::dquat rotation(1, 0, 0, 0);
  if (light.Has("rotation")) {
    const auto& given = light.Get("rotation");
    if (!given.IsArray() || given.ArrayLen() != 4) throw SceneError(what + ": rotation is no quaternion");
    const auto part = [&](int i) { return number(given.Get(i), what + ": rotation"); };
    rotation = glm::dquat(part(3), part(0), part(1), part(2));
    if (!(glm::length(rotation) > 1e-6)) throw SceneError(what + ": rotation is no quaternion");
    rotation = glm::normalize(rotation);
  }
  const auto& list = light.Get("irradianceCoefficients");
  if (!list.IsArray() || list.ArrayLen() != shares.size())
    throw SceneError(what + ": irradianceCoefficients are not nine");
  std::array<glm::dvec3, 9> coefficients;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto& colour = list.Get(i);
    if (!colour.IsArray() || colour.ArrayLen() != 3)
      throw SceneError(what + ": irradianceCoefficients are not three channels each");
    for (int channel = 0; channel < 3; ++channel)
      coefficients[i][channel] =
          intensity / shares[i] * number(colour.Get(channel), what + ": irradianceCoefficients");
  }
  Sky sky = empty_sky(harmonic_columns, harmonic_columns / 2);
  for (std::uint32_t pixel = 0; pixel < sky.radiance.size(); ++pixel) {
    const auto direction = glm::dvec3(direction_of(sky, pixel % sky.width, pixel / sky.width));
    const auto basis = harmonics(glm::inverse(rotation) * direction);
    glm::dvec3 radiance(0);
    for (std::size_t i = 0; i < basis.size(); ++i) radiance += basis[i] * coefficients[i];
    sky.radiance[pixel] = checked(glm::max(radiance, 0.0), what);
  }
  return {.sky = std::move(sky), .suns = {}};
}

std::optional<FoundSky> sky_of_extras(const tinygltf::Value& extras, const fs::path& folder) {
  if (!extras.IsObject() || !extras.Has("sky")) return {};
  const auto& sky = extras.Get("sky");
  const std::string what = "extras.sky";
  if (sky.IsArray() && sky.ArrayLen() == 3)
    return even_sky({number(sky.Get(0), what), number(sky.Get(1), what), number(sky.Get(2), what)}, what);
  if (!sky.IsString()) throw SceneError(what + " is neither [R, G, B] nor the name of a .hdr or .exr");
  return sky_of_file(folder / sky_file_of(extras));
}

std::optional<FoundSky> sky_of_extension(const tinygltf::Model& model, const tinygltf::Scene& scene) {
  constexpr const char* name = "EXT_lights_image_based";
  const auto used = scene.extensions.find(name), all = model.extensions.find(name);
  if (used == scene.extensions.end()) return {};
  const std::string what = name;
  const int index = used->second.IsObject() && used->second.Get("light").IsInt()
                        ? used->second.Get("light").GetNumberAsInt()
                        : -1;
  const auto* lights =
      all != model.extensions.end() && all->second.IsObject() ? &all->second.Get("lights") : nullptr;
  if (!lights || !lights->IsArray() || index < 0 || static_cast<std::size_t>(index) >= lights->ArrayLen() ||
      !lights->Get(index).IsObject())
    throw SceneError(what + ": there is no light " + std::to_string(index));
  return sky_of_harmonics(lights->Get(index), what + ", light " + std::to_string(index));
}

}  // namespace

FoundSky sky_of(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  glm::dvec3 radiance;
  char a = 0, b = 0;
  if (in >> radiance.r >> a >> radiance.g >> b >> radiance.b && a == ',' && b == ',' && in.peek() == EOF)
    return even_sky(radiance, "sky " + text);
  return sky_of_file(text);
}

std::string sky_file_of(const tinygltf::Value& extras) {
  if (!extras.IsObject() || !extras.Has("sky") || !extras.Get("sky").IsString()) return "";
  const fs::path file = extras.Get("sky").Get<std::string>();
  if (file.empty() || file.filename() != file)
    throw SceneError("extras.sky \"" + file.string() +
                     "\" leaves the scene's folder; put the file beside the scene");
  return file.string();
}

std::optional<FoundSky> find_sky(const tinygltf::Model& model, int scene, const fs::path& folder) {
  const auto& of = model.scenes[static_cast<std::size_t>(scene)];
  if (auto found = sky_of_extras(of.extras, folder)) return found;
  return sky_of_extension(model, of);
}

}  // namespace lichtveld::scene
