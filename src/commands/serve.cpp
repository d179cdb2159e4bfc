// lichtveld serve: the render server of a room.
#include <spdlog/spdlog.h>

#include <chrono>
#include <fstream>

#include "command_list.hpp"
#include "lichtveld/lightfield/thesis.hpp"
#include "lichtveld/scene/collision.hpp"
#include "lichtveld/stream/encoder.hpp"
#include "lichtveld/stream/hash.hpp"
#include "options.hpp"
#include "place_inbox.hpp"
#include "quality.hpp"
#include "stop_signals.hpp"

namespace lichtveld::commands {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Places = std::vector<stream::Place>;

// Half of what two maps a second allow, because browsers may share the machine.
constexpr auto budget_a_map = 250ms;
constexpr std::size_t cubes_of_players = 2;

struct ServeOptions {
  std::string scene, signaling, token_file, bind;
  double rate = 30;
  Method method = Method::thesis;
  bool chosen_quality = false;
  gpu::DeviceOptions device;
  lightfield::Settings settings{
      .bounces = 2, .abuffer = lightfield::ABuffer::list, .sort = lightfield::Sort::scan};
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

class RenderLoop {
 public:
  RenderLoop(const scene::Scene& scene, const gpu::Device& device, const lightfield::Settings& settings)
      : scene_(scene), size_(settings.size), method_(device, scene, settings) {}

  void render(const Places& places, stream::Server& server) {
    method_.solve(offsets_of(scene_, places));
    server.publish(stream::encode_png(method_.presented(), size_), places);
  }

 private:
  const scene::Scene& scene_;
  std::uint32_t size_;
  lightfield::Thesis method_;
};

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
    options.settings =
        finest_within(budget_a_map, device, scene, options.settings, [&] { return inbox.stopped(); });
  scene::check_atlas(scene, options.settings.size);

  RenderLoop loop(scene, device, options.settings);
  const Places rest = places_at_rest(scene);
  stream::Server server({.signaling = options.signaling,
                         .token = token,
                         .scene_hash = stream::sha256_of_file(options.scene),
                         .bind_address = options.bind,
                         .places = rest,
                         .mover = [&scene](std::size_t cube, const Places& places,
                                           stream::Move move) { return moved(scene, cube, places, move); },
                         .places_changed = [&inbox](const Places& places) { inbox.put(places); }});
  loop.render(rest, server);
  spdlog::info("serving {}: --size {} --psf {} on {}", options.scene, options.settings.size,
               options.settings.psf, device.summary().name);

  const std::chrono::duration<double> shortest(1 / options.rate);
  while (!inbox.stopped() && server.refused().empty()) {
    const auto places = inbox.take(500ms);
    if (!places) continue;
    const auto start = Clock::now();
    loop.render(*places, server);
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(shortest));
  }
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
  command->get_option("--size")->default_str("the finest that this machine renews twice a second");
  command->get_option("--psf")->default_str("likewise");
  add_bounces_option(*command, options->settings);
  add_method_option(*command, options->method, {Method::thesis});
  add_light_field_options(*command, options->settings);
  add_device_options(*command, options->device);
  command->callback([options, command] {
    options->chosen_quality = command->count("--size") + command->count("--psf") > 0;
    serve(*options);
  });
}

}  // namespace lichtveld::commands
