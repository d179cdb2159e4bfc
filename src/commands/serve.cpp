// lichtveld serve: the render server of a room.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stop_token>

#include "command_list.hpp"
#include "lichtveld/files/hash.hpp"
#include "lichtveld/lightfield/choice.hpp"
#include "lichtveld/room/room.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/stream/encoder.hpp"
#include "lichtveld/stream/protocol.hpp"
#include "lichtveld/stream/server.hpp"
#include "light_options.hpp"
#include "options.hpp"
#include "stop_signals.hpp"

namespace lichtveld::commands {

namespace {

using namespace std::chrono_literals;

// Light maps a second that a map after a step leaves room for, where nobody asks for another rate.
constexpr double usual_rate = 15;
// Of a map's share of a second it may take so much: browsers that share the machine and draw without a GPU make
// it take two to three times as long.
constexpr double share_of_a_map = 1.0 / 3;
// Light that is off by more shows as blotches.
constexpr double visible_error = 0.1;
constexpr double longest_adaptation = 60;    // [s]
constexpr std::size_t cubes_of_players = 2;  // as stream's protocol has it

struct ServeOptions {
  std::string scene, token_file;
  bool keep_uv = false;
  LightOptions lights;
  room::Eye eye;
  stream::ServerOptions stream;  // what the command line says of it
  std::string udp_port;          // PORT or FIRST-LAST; empty: any
  double rate = 30;
  Method method;
  bool rate_is_asked_for = false;
  std::optional<lightfield::Forecast::Fixed> to_choose;  // what is fixed, if anything is to be chosen
  gpu::DeviceOptions device;
  CaptureOptions capture;
  lightfield::Settings settings{
      .thesis = {.abuffer = lightfield::ABuffer::list, .sort = lightfield::Sort::scan}};
};

std::string read_token(const std::string& file) {
  std::ifstream in(file);
  std::string token;
  if (!in || !(in >> token)) throw UsageError("--token-file " + file + ": it cannot be read or is empty");
  return token;
}

stream::UdpPorts read_udp_ports(const std::string& text) {
  const auto number = [&](std::string_view digits) {
    unsigned short port = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (error != std::errc() || end != digits.data() + digits.size() || port == 0)
      throw UsageError("--udp-port " + text + ": give a port from 1 to 65535, or two as in 40000-40100");
    return port;
  };
  const std::string_view view = text;
  const auto dash = view.find('-');
  const auto first = number(view.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : number(view.substr(dash + 1));
  if (first > last) throw UsageError("--udp-port " + text + ": the first port has to come before the last");
  return {first, last};
}

stream::Place seen_from_front(const glm::vec3& place) {
  return {place.x, place.y};
}

std::vector<stream::Place> seen_from_front(const room::Places& places) {
  std::vector<stream::Place> seen;
  for (const auto& place : places) seen.push_back(seen_from_front(place));
  return seen;
}

// The cubes that players move are the scene's first movable bodies, which keep their depth.
room::Places with_depth(const std::vector<stream::Place>& places, const room::Places& rest) {
  room::Places found;
  for (std::size_t cube = 0; cube < places.size(); ++cube)
    found.emplace_back(places[cube].x, places[cube].y, rest[cube].z);
  return found;
}

room::Direction direction_of(stream::Move move) {
  switch (move) {
    case stream::Move::left:
      return room::Direction::left;
    case stream::Move::right:
      return room::Direction::right;
    case stream::Move::down:
      return room::Direction::down;
    case stream::Move::up:
      return room::Direction::up;
  }
  throw std::logic_error("no such move");
}

std::string colour_of(const glm::vec3& srgb) {
  const glm::ivec3 bytes = glm::round(255.0f * srgb);
  return fmt::format("#{:02x}{:02x}{:02x}", bytes.r, bytes.g, bytes.b);
}

stream::EncodedMap encoded(const room::Map& map, const scene::Scene& scene, const glm::vec3& sky) {
  return {
      .format = stream::MapFormat::png,
      .bytes = stream::encode_png(map.shown.bytes, map.shown.size),
      .places = seen_from_front(map.places),
      .sky = scene.sky ? colour_of(lightfield::displayed(map.scales[scene.sky->light] * sky, map.shown)) : ""};
}

stream::Work as_sent(const room::Work& work) {
  stream::Work sent;
  for (const auto& [name, runs, seconds] : work.stages) sent.stages.push_back({name, runs, seconds});
  for (const auto& [name, runs, seconds] : work.passes) sent.passes.push_back({name, runs, seconds});
  for (const auto& [name, value] : work.counts) sent.counts.push_back({name, value});
  return sent;
}

// Those that players switch, of the scene's.
std::vector<std::size_t> switchable_lights(const scene::Scene& scene) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (scene.lights[i].switchable) found.push_back(i);
  if (found.size() <= stream::most_lights) return found;
  spdlog::warn("{}: of {} lights that switch the first {} are the players'", scene.file, found.size(),
               stream::most_lights);
  found.resize(stream::most_lights);
  return found;
}

// At the end, or when something throws: no map goes to a server that is no more, no player's key to a room that
// is none.
struct Closing {
  room::Room& room;
  std::unique_ptr<stream::Server>& server;
  ~Closing() {
    room.close();
    server.reset();
  }
};

// A room goes on without its capture.
void update_room(std::optional<gpu::Capture>& capture, const std::function<void()>& work) {
  try {
    update(capture, work);
  } catch (const gpu::CaptureError& error) {
    spdlog::error("{}", error.what());
  }
}

// The finest light maps that this machine renews often enough; says what to expect of them. The light field of
// that quality, if the last trial made it.
std::unique_ptr<lightfield::LightField> choose_quality(ServeOptions& options, const lightfield::Engine& engine,
                                                       const gpu::Device& device, const scene::Scene& scene,
                                                       const std::function<bool()>& stopped) {
  lightfield::Forecast forecast(engine, device, scene, options.settings, *options.to_choose, stopped);
  const auto finest_at = [&](double rate) {
    return forecast.finest_within(
        std::chrono::milliseconds(std::max(std::lround(1000 * share_of_a_map / rate), 1L)));
  };
  auto expected = finest_at(options.rate_is_asked_for ? options.rate : usual_rate);
  // Where nobody asks for a rate, fewer maps are better than blotches.
  if (!options.rate_is_asked_for && expected.error > visible_error) expected = finest_at(usual_rate / 2);
  options.settings.size = expected.quality.size;
  options.settings.psf = expected.quality.psf;
  spdlog::info("--size {} --psf {}: a map in {:.0f} ms after a move, {:.1f} % off", expected.quality.size,
               expected.quality.psf, expected.step_ms, 100 * expected.error);
  if (expected.error > visible_error)
    spdlog::warn(
        "light maps {:.0f} % off show blotches: a lower --rate, a larger lamp or a faster machine would help",
        100 * expected.error);
  return forecast.take(expected.quality);
}

void serve(ServeOptions options) {
  if (!(options.rate > 0 && options.rate <= 1000))
    throw UsageError("--rate: maps a second, above 0 and up to 1000");
  lightfield::check(options.settings);
  check(options.capture);
  if (!options.udp_port.empty()) options.stream.udp_ports = read_udp_ports(options.udp_port);
  stream::check_addresses(options.stream);
  std::stop_source stop;
  const StopSignals signals([&] { stop.request_stop(); });
  const auto scene =
      load(options.scene, options.lights, {.size = options.settings.size, .keep_uv = options.keep_uv});
  auto scales = scales_of(scene, options.lights);
  options.stream.token = read_token(options.token_file);
  options.stream.scene_hash =
      scene.unwrapped.empty() ? files::sha256_of_file(options.scene) : files::sha256_of(scene.unwrapped);
  if (!scene.unwrapped.empty())
    spdlog::warn(
        "{}: browsers need the file that was made of it: give signaling what `lichtveld unwrap --size {}` "
        "writes",
        options.scene, options.settings.size);
  auto capture = make_capture(options.capture, 0);
  const gpu::Device device(options.device);
  const auto& engine = engine_of(options.method, device, scene, options.settings);
  std::unique_ptr<lightfield::LightField> light;
  if (options.to_choose)
    light = choose_quality(options, engine, device, scene, [&] { return stop.stop_requested(); });
  scene::check_atlas(scene, options.settings.size);
  if (!light) light = engine.make(device, scene, options.settings);

  const auto rest = room::places_at_rest(scene, cubes_of_players);
  const glm::vec3 sky = scene.sky ? scene::mean_radiance(*scene.sky) : glm::vec3(0);
  std::unique_ptr<stream::Server> server;
  room::Room room(scene, std::move(light),
                  {.rate = options.rate,
                   .eye = options.eye,
                   .scales = scales,
                   .bodies = cubes_of_players,
                   .publish = [&](const room::Map& map) { server->publish(encoded(map, scene, sky)); },
                   .ended = [&] { return !server->refused().empty(); },
                   .around_update = [&](const std::function<void()>& work) { update_room(capture, work); }});
  const Closing closing{room, server};
  const std::stop_callback on_stop(stop.get_token(), [&] { room.stop(); });
  options.stream.places = seen_from_front(rest);
  options.stream.mover = [&](std::size_t cube, const std::vector<stream::Place>& places, stream::Move move) {
    return seen_from_front(room.stepped(with_depth(places, rest), cube, direction_of(move)));
  };
  options.stream.places_changed = [&](const std::vector<stream::Place>& places) {
    room.place(with_depth(places, rest));
  };
  const auto switchable = switchable_lights(scene);
  for (const auto light : switchable) {
    const glm::vec3 scale = glm::min(scales[light], stream::brightest_light);
    options.stream.lights.push_back({scene.lights[light].node, {scale.r, scale.g, scale.b}});
  }
  options.stream.lights_changed = [&](const std::vector<stream::Light>& lights) {
    for (std::size_t i = 0; i < lights.size(); ++i)
      scales[switchable[i]] = {lights[i].scale[0], lights[i].scale[1], lights[i].scale[2]};
    room.dim(scales);
  };
  options.stream.work = [&] { return as_sent(room.work()); };
  server = std::make_unique<stream::Server>(std::move(options.stream));
  room.begin();
  spdlog::info("serving {}: --method {} --size {} --psf {} on {}", options.scene, engine.name,
               options.settings.size, options.settings.psf, device.summary().name);
  room.run();
  if (const auto why = server->refused(); !why.empty()) throw UsageError(why);
  const auto totals = server->statistics();
  spdlog::info("stopped: {} maps and {} MiB sent, {} maps skipped by slow clients, {} messages refused",
               totals.maps_sent, totals.bytes_sent >> 20, totals.maps_skipped, totals.messages_refused);
  if (capture && !capture->taken())
    spdlog::warn("{} is not there: stopped before {} updates; try a smaller --capture-after",
                 capture->file().string(), capture->skipped() + 1);
  check_validation(device);
}

void add_eye_options(CLI::App& command, room::Eye& eye) {
  command
      .add_option_function<std::string>(
          "--exposure",
          [&eye](const std::string& text) {
            float value = 0;
            if (text == "auto") return eye.fixed.reset();
            if (!CLI::detail::lexical_cast(text, value) || !(value > 0 && std::isfinite(value)))
              throw UsageError("--exposure " + text + ": auto, or the radiance that is middle grey, above 0");
            eye.fixed = value;
          },
          "What is shown as middle grey: the mean of what is lit, as an eye adapts, or always the same "
          "radiance "
          "[W/m2/sr]")
      ->type_name("auto|L")
      ->default_str("auto");
  command
      .add_option_function<std::string>(
          "--adapt",
          [&eye](const std::string& text) {
            const auto parts = CLI::detail::split(text, ',');
            double brighter = 0, darker = 0;
            if (parts.size() != 2 || !CLI::detail::lexical_cast(parts[0], brighter) ||
                !CLI::detail::lexical_cast(parts[1], darker) ||
                !(brighter >= 0 && brighter <= longest_adaptation) ||
                !(darker >= 0 && darker <= longest_adaptation))
              throw UsageError("--adapt " + text + ": two time constants of 0..60 s, as in 0.3,0.9");
            eye.brighter = brighter;
            eye.darker = darker;
          },
          "Time constants with which the exposure follows where it becomes brighter, and darker [s]; 0,0: at "
          "once")
      ->type_name("S,S")
      ->default_str("0.3,0.9");
}

}  // namespace

void add_serve(CLI::App& application) {
  auto* command = application.add_subcommand("serve", "Light a room for players: the render server");
  const auto options = std::make_shared<ServeOptions>();
  command->add_option("--scene", options->scene, "The scene, .glb or .gltf")->required();
  command
      ->add_option("--signaling", options->stream.signaling,
                   "The signaling server, ws://HOST:PORT/server or wss://...")
      ->required();
  command->add_option("--token-file", options->token_file, "A file with the token that signaling knows")
      ->required();
  command->add_option(
      "--ca-file", options->stream.ca_file,
      "A PEM file with the authorities that may sign signaling's certificate (default: the system's)");
  command->add_option("--bind", options->stream.bind_address,
                      "The address that WebRTC binds to (default: every address)");
  command->add_option(
      "--udp-port", options->udp_port,
      "The UDP port that all clients share, or a range such as 40000-40100 of which each takes one "
      "(default: any)");
  command->add_option(
      "--public-ip", options->stream.public_address,
      "The address at which this machine is reached from outside, where a 1:1 NAT stands before it");
  command->add_option("--rate", options->rate, "Most light maps a second")->capture_default_str();
  add_light_options(*command, options->lights);
  add_keep_uv_option(*command, options->keep_uv);
  add_buried_option(*command, options->settings);
  add_eye_options(*command, options->eye);
  add_quality_options(*command, options->settings);
  command->get_option("--size")->default_str(
      "the finest that this machine renews at --rate, or 15 times a second");
  command->get_option("--psf")->default_str("likewise");
  add_bounces_option(*command, options->settings);
  add_method_option(*command, options->method, false);
  add_light_field_options(*command, options->settings);
  add_step_bounces_option(*command, options->settings);
  add_device_options(*command, options->device);
  add_capture_options(*command, options->capture, "0");
  command->callback([options, command] {
    choose_engines(*command, options->method);
    if (command->count("--step-bounces") > 0 && options->settings.bounces)
      throw UsageError("--step-bounces is for --bounces auto, whose light goes on where it was; leave it out");
    options->rate_is_asked_for = command->count("--rate") > 0;
    const auto fixed = [&](const char* option, std::uint32_t value) {
      return command->count(option) > 0 ? std::optional(value) : std::nullopt;
    };
    options->to_choose = {.size = fixed("--size", options->settings.size),
                          .psf = fixed("--psf", options->settings.psf)};
    if (command->count("--psf-size") > 0 || (options->to_choose->size && options->to_choose->psf))
      options->to_choose.reset();
    serve(*options);
  });
}

}  // namespace lichtveld::commands
