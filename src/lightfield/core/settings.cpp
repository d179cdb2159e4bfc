#include "lichtveld/lightfield/settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lichtveld/lightfield/directions.hpp"

namespace lichtveld::lightfield {

namespace {
constexpr int most_step_bounces = 100;
constexpr std::array parts_of_a_bounce = {0.125f, 0.25f, 0.5f};

template <typename Value>
std::string word_of(const std::map<std::string, Value>& words, Value wanted) {
  return std::ranges::find(words, wanted, [](const auto& entry) { return entry.second; })->first;
}
}  // namespace

const std::map<std::string, ABuffer>& words_of_abuffers() {
  static const std::map<std::string, ABuffer> words = {{"stencil", ABuffer::stencil}, {"list", ABuffer::list}};
  return words;
}

const std::map<std::string, Sort>& words_of_sorts() {
  static const std::map<std::string, Sort> words = {
      {"bitonic", Sort::bitonic}, {"compare-swap", Sort::compare_swap}, {"scan", Sort::scan}};
  return words;
}

const std::map<std::string, Weights>& words_of_weights() {
  static const std::map<std::string, Weights> words = {{"solid-angle", Weights::solid_angle},
                                                       {"equal", Weights::equal}};
  return words;
}

const std::map<std::string, Direct>& words_of_directs() {
  static const std::map<std::string, Direct> words = {{"exact", Direct::exact}, {"psf", Direct::psf}};
  return words;
}

const std::map<std::string, Buried>& words_of_burieds() {
  static const std::map<std::string, Buried> words = {{"neighbours", Buried::neighbours}, {"lit", Buried::lit}};
  return words;
}

std::string name_of(ABuffer abuffer) {
  return word_of(words_of_abuffers(), abuffer);
}
std::string name_of(Sort sort) {
  return word_of(words_of_sorts(), sort);
}
std::string name_of(Weights weights) {
  return word_of(words_of_weights(), weights);
}

std::uint32_t PsfSize::pixels(std::uint32_t size) const {
  if (times && value == 1) return 0;  // the settings' word for it
  return static_cast<std::uint32_t>(std::max(std::lround(times ? value * size : value), 1L));
}

void check(const Settings& settings) {
  if (settings.size < 16 || settings.size > 4096)
    throw std::invalid_argument("a size of " + std::to_string(settings.size) +
                                " texels: it must lie in 16..4096");
  if (settings.psf_size != 0 && (settings.psf_size < 16 || settings.psf_size > 8192))
    throw std::invalid_argument("a PSF raster of " + std::to_string(settings.psf_size) +
                                " pixels: it must lie in 16..8192, or be 0: as fine as the atlas");
  DirectionSet(settings.psf);
  if (settings.layers < 1 || settings.layers > most_layers)
    throw std::invalid_argument(std::to_string(settings.layers) + " layers: there must be 1.." +
                                std::to_string(most_layers));
  if (std::ranges::count(parts_of_a_bounce, settings.links.step_bounces) == 0 &&
      !(settings.links.step_bounces >= 1 && settings.links.step_bounces <= most_step_bounces &&
        settings.links.step_bounces == std::floor(settings.links.step_bounces)))
    throw std::invalid_argument(
        std::to_string(settings.links.step_bounces) +
        " bounces a step: there must be 0.125, 0.25, 0.5 or a whole number of them, up to " +
        std::to_string(most_step_bounces));
  if (settings.rays.sets != 1 && settings.rays.sets != 4 && settings.rays.sets != 16)
    throw std::invalid_argument(std::to_string(settings.rays.sets) +
                                " sets of directions: there must be 1, 4 or 16");
  if (settings.bounces == 0u)
    throw std::invalid_argument("0 bounces: 1 is direct light alone, 2 adds one reflection");
}

}  // namespace lichtveld::lightfield
