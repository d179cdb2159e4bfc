#include "examine.hpp"

#include <OpenImageIO/imageio.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <set>
#include <typeinfo>

#include "check.hpp"
#include "gutters.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/buried.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/scene/unwrap.hpp"
#include "lit_file.hpp"
#include "scene_log.hpp"

namespace lichtveld::mutants {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t size = 16;  // texels a side
constexpr std::uint32_t directions = 8;
constexpr const char* map_name = "E.exr";
constexpr const char* lit_name = "lit.glb";

// One mutant's way through the commands. A command's step ends in what it throws: a refusal, as
// src/commands/run.cpp has it, or a fault.
class Examination {
 public:
  Examination(const Mutant& mutant, const fs::path& folder, const gpu::Device& device, const Care& care,
              void (*doing)(const char*))
      : mutant_(mutant), folder_(folder), device_(device), care_(care), doing_(doing) {}

  Verdict verdict() {
    for (const auto& [name, bytes] : mutant_.files) std::ofstream(folder_ / name, std::ios::binary) << bytes;
    const std::string checked = refusal_of("check", [&] { check(); });
    std::optional<std::string> loaded;
    const std::string baked = refusal_of("bake", [&] {
      auto scene = load();
      loaded = "";
      bake(std::move(scene));
    });
    if (checked != loaded.value_or(baked))
      fault(fmt::format("check says \"{}\", and bake \"{}\"", checked, baked));
    look_at_folder(baked.empty());
    verdict_.refusal = baked;
    return std::move(verdict_);
  }

 private:
  void fault(const std::string& what) { verdict_.faults.push_back(what); }
  fs::path scene_file() const { return folder_ / mutant_.name; }
  scene::LoadOptions options() const { return {.unwrap = {.size = size, .light_map = map_name}}; }

  void require(bool holds, const std::string& otherwise) {
    if (!holds) fault(otherwise);
  }

  // The message of what is refused, or nothing.
  std::string refusal_of(const char* command, const std::function<void()>& run) {
    const auto unexpected = [&](const std::exception& error) {
      fault(fmt::format("{}: threw {}: {}", command, typeid(error).name(), error.what()));
      return std::string(error.what());
    };
    doing_(command);
    try {
      run();
      return {};
    } catch (const scene::SceneError& error) {
      return message_of(command, error.what());
    } catch (const std::bad_alloc& error) {
      return unexpected(error);
    } catch (const std::runtime_error& error) {
      // What does not fit into memory is told before it is taken (lightfield/core/memory.hpp).
      const std::string what = error.what();
      return what.find(" MiB, and ") != std::string::npos ? what : unexpected(error);
    } catch (const std::exception& error) {
      return unexpected(error);
    }
  }

  // A message is for people: of the file, in words of ours, and nothing that a terminal obeys.
  std::string message_of(const char* command, const std::string& what) {
    const std::string path = scene_file().string();
    require(what.starts_with(path),
            fmt::format("{}: \"{}\" does not begin with the file's name", command, what));
    require(std::ranges::none_of(what, [](unsigned char c) { return c < ' ' || c == 127; }),
            fmt::format("{}: \"{}\" has control characters", command, what));
    require(what.size() < 1000, fmt::format("{}: a message of {} letters", command, what.size()));
    for (const char* inside : {"json.exception.type", "json.exception.invalid", "std::", "basic_string",
                               "vector::", "_M_", "map::at", "stoul", "stoi", "bad_", "unknown reason"})
      require(what.find(inside) == std::string::npos, fmt::format("{}: \"{}\" speaks of code", command, what));
    std::string message = what;
    for (std::size_t at; (at = message.find(path)) != std::string::npos;)
      message.replace(at, path.size(), "FILE");
    return message;
  }

  void check() {
    auto [scene, facts] = scene::check(scene_file(), options());
    doing_("check's page");
    commands::CheckedScene result{
        .file = mutant_.name,
        .facts = std::move(facts),
        .texels_buried = lightfield::BuriedTexels(scene, size).count(),
        .outlook = {.device = {}, .method = {}, .expected = {}, .why_not = "--no-trial"}};
    if (care_.trial && result.facts.atlas.texels > 0 && scene::has_light(scene)) {
      doing_("check's trial");
      const auto& engine = lightfield::engine("rays");
      lightfield::Settings settings;
      settings.size = size;
      const lightfield::Forecast forecast(engine, device_, scene, settings, {.size = size, .psf = directions},
                                          [] { return true; });
      result.outlook.expected = forecast.of({size, directions});
    }
    require(!commands::page_of(result).empty(), "check: an empty page");
    require_numbers(commands::json_of(result), "check --json");
    require(commands::picture_of(result.facts.atlas).size > 0, "check: an empty picture");
  }

  // That JSON has a text for: NaN and infinity would be null.
  void require_numbers(const nlohmann::ordered_json& json, const std::string& where) {
    if (json.is_number_float()) require(std::isfinite(json.get<double>()), where + " is " + json.dump());
    if (json.is_structured())
      for (const auto& [key, value] : json.items()) require_numbers(value, where + "/" + key);
  }

  scene::Scene load() {
    doing_("load");
    return scene::load(scene_file(), options());
  }

  void bake(scene::Scene scene) {
    doing_("unwrap");
    if (care_.unwrapped) write_lit(scene);
    scene = scene::dimmed(std::move(scene), scene::full(scene));
    scene::check_atlas(scene, size);
    doing_("rays");
    lightfield::Settings settings;
    settings.size = size;
    settings.psf = directions;
    const auto light = lightfield::make_light_field("rays", device_, scene, settings);
    light->place(scene::Offsets(scene.bodies.size(), glm::vec3(0)));
    const auto solution = light->settle();
    require(std::isfinite(solution.error_estimate), "bake: the estimated error is no number");
    require(!std::isnan(solution.residual), "bake: the residual is no number");
    auto irradiance = light->irradiance();
    doing_("shown");
    if (care_.shown) require(!light->shown().bytes.empty(), "bake: nothing is shown");
    doing_("finish");
    lightfield::BuriedTexels(scene, size).take_light_of_neighbours(irradiance);
    commands::Gutters(scene, size).fill(irradiance);
    require(std::ranges::all_of(
                irradiance,
                [](const glm::vec4& e) {
                  return std::min({e.r, e.g, e.b, e.a}) >= 0 && std::isfinite(e.r + e.g + e.b + e.a);
                }),
            "bake: an irradiance that is negative or no number");
    files::write_exr(folder_ / map_name, irradiance, size);
    compare_file(irradiance);
  }

  // The scene as it is written for other programs is one that these commands read.
  void write_lit(scene::Scene& scene) {
    const auto lit = commands::lit_file(scene_file(), options().unwrap, scene, folder_ / lit_name);
    files::write_bytes(folder_ / lit_name, lit.glb);
    doing_("load what was unwrapped");
    try {
      scene::load(folder_ / lit_name, options());
    } catch (const scene::SceneError& error) {
      fault(std::string("bake --gltf: is refused itself: ") + error.what());
    }
  }

  void compare_file(const std::vector<glm::vec4>& irradiance) {
    const auto in = OIIO::ImageInput::open((folder_ / map_name).string());
    std::vector<glm::vec4> read(irradiance.size());
    const bool whole = in && in->spec().width == static_cast<int>(size) &&
                       in->spec().height == static_cast<int>(size) && in->spec().nchannels == 4 &&
                       in->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, read.data());
    require(whole && std::memcmp(read.data(), irradiance.data(), read.size() * sizeof(glm::vec4)) == 0,
            "bake: the file is not what was baked");
  }

  // Its output is there or not, and nothing else is beside it.
  void look_at_folder(bool baked) {
    std::set<std::string> expected;
    for (const auto& [name, bytes] : mutant_.files) expected.insert(name);
    if (baked) expected.insert(map_name);
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename();
      if (expected.erase(name) == 0 && name != lit_name) fault("left behind: " + name);
      fs::remove(entry.path());
    }
    for (const auto& name : expected) fault("missing: " + name);
  }

  const Mutant& mutant_;
  const fs::path& folder_;
  const gpu::Device& device_;
  const Care care_;
  void (*const doing_)(const char*);
  Verdict verdict_;
};

}  // namespace

Verdict examine(const Mutant& mutant, const fs::path& folder, const gpu::Device& device, const Care& care,
                void (*doing)(const char* what)) {
  const testing::LogCapture log;
  return Examination(mutant, folder, device, care, doing).verdict();
}

}  // namespace lichtveld::mutants
