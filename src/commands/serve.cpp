// lichtveld serve: the render server of a room.
#include <spdlog/spdlog.h>

#include <chrono>
#include <fstream>
#include <optional>
#include <utility>

#include "command_list.hpp"
#include "lichtveld/files/hash.hpp"
#include "lichtveld/scene/collision.hpp"
#include "map_sender.hpp"
#include "options.hpp"
#include "place_inbox.hpp"
#include "quality.hpp"
#include "solver.hpp"
#include "stop_signals.hpp"
#include "work_log.hpp"

namespace lichtveld::commands {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Places = std::vector<stream::Place>;

// What a light map after a step may take: half of what 15 a second allow, because browsers may share the
// machine.
constexpr auto budget_a_map = 33ms;
// Light maps after the last step: with the last of them light has settled, however bright the room. The others
// have so many bounces.
constexpr std::uint32_t maps_to_settle = 3, bounces_to_settle = 10;
constexpr std::size_t cubes_of_players = 2;
// While nothing moves, pairs of directions that are routed again every second, until all have been.
constexpr std::uint32_t pairs_a_check = 2;

struct ServeOptions {
  std::string scene, signaling, token_file, bind;
  double rate = 30;
  Method method = Method::links;
  bool chosen_quality = false;
  gpu::DeviceOptions device;
  lightfield::Settings settings{.abuffer = lightfield::ABuffer::list, .sort = lightfield::Sort::scan};
};

std::string read_token(const std::string& file) {
  std::ifstream in(file);
  std::string token;
  if (!in || !(in >> token)) throw UsageError("--token-file " + file + ": it cannot be read or is empty");
  return token;
}

// The cubes are the first movable bodies: cube i is body i + 1.
Places places_at_rest(const scene::Scene& scene) {
  Places places;
  for (std::size_t body = 1; body < scene.bodies.size() && places.size() < cubes_of_players; ++body)
    places.push_back({scene.bodies[body].place.x, scene.bodies[body].place.y});
  return places;
}

std::vector<glm::vec3> offsets_of(const scene::Scene& scene, const Places& places) {
  std::vector<glm::vec3> offsets(scene.bodies.size(), glm::vec3(0));
  for (std::size_t cube = 0; cube < places.size(); ++cube) {
    const auto& rest = scene.bodies[cube + 1].place;
    offsets[cube + 1] = {places[cube].x - rest.x, places[cube].y - rest.y, 0};
  }
  return offsets;
}

stream::Place moved(const scene::Scene& scene, std::size_t cube, const Places& places, stream::Move move) {
  const float step = scene::step_length(scene);
  const glm::vec3 wanted = move == stream::Move::left    ? glm::vec3(-step, 0, 0)
                           : move == stream::Move::right ? glm::vec3(step, 0, 0)
                           : move == stream::Move::down  ? glm::vec3(0, -step, 0)
                                                         : glm::vec3(0, step, 0);
  const auto body = static_cast<std::uint32_t>(cube + 1);
  const auto free = scene::free_step(scene, offsets_of(scene, places), body, wanted);
  return {places[cube].x + free.x, places[cube].y + free.y};
}

// Keeps the light of the room: the part of the pipeline that owns the device.
class Light {
 public:
  Light(const scene::Scene& scene, const gpu::Device& device, const ServeOptions& options, WorkLog& log)
      : scene_(scene), log_(log), solver_(make_solver(options.method, device, scene, options.settings)) {}

  // The light map with the cubes at these places, sRGB RGBA; nothing once the light has settled. It ends early
  // where enough() says so.
  std::optional<std::vector<std::uint8_t>> update(const Places& places, const Solver::Enough& enough) {
    if (settled_ && places == places_) return std::nullopt;
    return log_.time("update", [&] {
      settled_ = solver_->update(offsets_of(scene_, places), enough).settled;
      places_ = places;
      log_.set_passes(solver_->times());
      return solver_->presented();
    });
  }

  bool settled() const { return settled_; }

  // Between maps, while nothing moves: whether what is kept is what a fresh build would find.
  void check() {
    const auto found = solver_->check_links(pairs_a_check);
    if (found.links == 0) return;
    log_.count("links_checked", found.links);
    log_.count("links_differing", found.differing);
    log_.set_passes(solver_->times());
    if (found.differing > 0 && !std::exchange(warned_, true))
      spdlog::warn("{} of {} links are not what a fresh build finds: a bug, please report it with the scene",
                   found.differing, found.links);
  }

 private:
  const scene::Scene& scene_;
  WorkLog& log_;
  std::unique_ptr<Solver> solver_;
  Places places_;
  bool settled_ = false, warned_ = false;
};

// Input and update; moves are placed and maps are sent on the server's thread, and encoded on the sender's.
// Ends when it is told to, or when signaling refuses the server.
void run_pipeline(Light& light, PlaceInbox& inbox, MapSender& sender, const stream::Server& server,
                  WorkLog& log, Places places, Clock::duration shortest) {
  std::uint32_t waited = 0;  // maps since a step
  while (!inbox.stopped() && server.refused().empty()) {
    const auto start = Clock::now();
    sender.wait();
    const auto news = inbox.take(light.settled() ? 1s : 0s);
    if (news) {
      log.add("input", Clock::now() - news->came);
      places = news->places;
    } else if (light.settled()) {
      light.check();
      continue;
    }
    // After a step as little as --step-bounces says, so that the next step is shown soon; while nothing moves
    // what is left, but no longer than until somebody moves again.
    waited = news ? 0 : waited + 1;
    auto map = light.update(places, [&](std::uint32_t bounces) {
      if (waited == 0 || inbox.has_news()) return true;
      return waited < maps_to_settle && bounces >= bounces_to_settle;
    });
    if (map) sender.send(std::move(*map), places);
    std::this_thread::sleep_until(start + shortest);
  }
}

void serve(ServeOptions options) {
  if (!(options.rate > 0 && options.rate <= 1000))
    throw UsageError("--rate: maps a second, above 0 and up to 1000");
  lightfield::check(options.settings);
  PlaceInbox inbox;
  const StopSignals signals([&] { inbox.stop(); });
  const auto scene = scene::load(options.scene);
  const auto token = read_token(options.token_file);
  const gpu::Device device(options.device);
  if (!options.chosen_quality)
    options.settings = finest_within(budget_a_map, options.method, device, scene, options.settings,
                                     [&] { return inbox.stopped(); });
  scene::check_atlas(scene, options.settings.size);

  WorkLog log;
  Light light(scene, device, options, log);
  const Places rest = places_at_rest(scene);
  stream::Server server({.signaling = options.signaling,
                         .token = token,
                         .scene_hash = files::sha256_of_file(options.scene),
                         .bind_address = options.bind,
                         .places = rest,
                         .mover =
                             [&](std::size_t cube, const Places& places, stream::Move move) {
                               return log.time("place", [&] { return moved(scene, cube, places, move); });
                             },
                         .places_changed = [&inbox](const Places& places) { inbox.put(places); },
                         .work = [&log] { return log.work(); }});
  MapSender sender(server, options.settings.size, log);
  if (auto map = light.update(rest, [](std::uint32_t) { return false; })) sender.send(std::move(*map), rest);
  spdlog::info("serving {}: --size {} --psf {} on {}", options.scene, options.settings.size,
               options.settings.psf, device.summary().name);
  run_pipeline(light, inbox, sender, server, log, rest,
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options.rate)));
  if (const auto why = server.refused(); !why.empty()) throw UsageError(why);
  const auto totals = server.statistics();
  spdlog::info("stopped: {} maps and {} MiB sent, {} maps skipped by slow clients, {} messages refused",
               totals.maps_sent, totals.bytes_sent >> 20, totals.maps_skipped, totals.messages_refused);
  check_validation(device);
}

}  // namespace

void add_serve(CLI::App& application) {
  auto* command = application.add_subcommand("serve", "Light a room for players: the render server");
  const auto options = std::make_shared<ServeOptions>();
  command->add_option("--scene", options->scene, "The scene, .glb or .gltf")->required();
  command->add_option("--signaling", options->signaling, "The signaling server, ws://HOST:PORT/server")
      ->required();
  command->add_option("--token-file", options->token_file, "A file with the token that signaling knows")
      ->required();
  command->add_option("--bind", options->bind, "The address that WebRTC binds to (default: every address)");
  command->add_option("--rate", options->rate, "Most light maps a second")->capture_default_str();
  add_quality_options(*command, options->settings);
  command->get_option("--size")->default_str("the finest that this machine renews 15 times a second");
  command->get_option("--psf")->default_str("likewise");
  add_bounces_option(*command, options->settings);
  add_method_option(*command, options->method, {Method::links, Method::thesis});
  add_light_field_options(*command, options->settings);
  add_step_bounces_option(*command, options->settings);
  add_device_options(*command, options->device);
  command->callback([options, command] {
    choose_method(*command, options->method);
    if (command->count("--step-bounces") > 0 && (options->method != Method::links || options->settings.bounces))
      throw UsageError(
          "--step-bounces is for --method links with --bounces auto, whose light goes on where it was; leave "
          "it out");
    if (options->method == Method::links && (command->count("--abuffer") > 0 || command->count("--sort") > 0))
      throw UsageError("--abuffer and --sort mean nothing to --method links; leave them out");
    options->chosen_quality =
        command->count("--size") + command->count("--psf") + command->count("--psf-size") > 0;
    serve(*options);
  });
}

}  // namespace lichtveld::commands
