// Options that several commands share, and the errors that the command line maps to exit statuses.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lichtveld/gpu/capture.hpp"
#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::commands {

// What the user asked for cannot be: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// --device and --validation.
void add_device_options(CLI::App& command, gpu::DeviceOptions& options);

// Throws std::runtime_error if the validation layers complained: a programmer's error must not pass unseen.
void check_validation(const gpu::Device& device);

// --keep-uv.
void add_keep_uv_option(CLI::App& command, bool& keep_uv);
// --buried.
void add_buried_option(CLI::App& command, lightfield::Settings& settings);

// Throws UsageError for sizes and densities that no atlas has.
void check(const scene::UnwrapOptions& options);

struct CaptureOptions {
  std::string file;                    // empty: no capture
  std::optional<std::uint32_t> after;  // updates before the one that is captured
};

// --capture and --capture-after. `after` says what is captured without the latter.
void add_capture_options(CLI::App& command, CaptureOptions& options, const std::string& after);

// Throws files::OutputError for a file that cannot be: worth asking before long work.
void check(const CaptureOptions& options);

// Nothing, if none is asked for. Make it before the device.
std::optional<gpu::Capture> make_capture(const CaptureOptions& options, std::uint32_t after_by_default);

// An update of the light, captured if it is its turn.
void update(std::optional<gpu::Capture>& capture, const std::function<void()>& work);

// What computes the light: an engine of the light field, or path tracing.
inline constexpr const char* reference_method = "reference";

struct Method {
  std::string name = "auto";
  // Of these, once the command line is read, one computes the light; none for the reference.
  std::vector<const lightfield::Engine*> engines = {};
  bool own_psf = true;  // as many directions as the engine takes by itself

  bool is_reference() const { return name == reference_method; }
};

// --method: an engine, auto, or where it is said so the reference.
void add_method_option(CLI::App& command, Method& method, bool with_reference);

// After the command line is read: which engines are left, as some options mean something to some methods alone.
// Throws UsageError for one that means nothing to the method.
void choose_engines(const CLI::App& command, Method& method);

// The engine that suits the device, and without --psf its number of directions.
const lightfield::Engine& engine_of(const Method& method, const gpu::Device& device, const scene::Scene& scene,
                                    lightfield::Settings& settings);

// --abuffer, --sort, --layers: how a light field is computed, whatever its quality.
void add_light_field_options(CLI::App& command, lightfield::Settings& settings);

// --size, --psf, --psf-size, --weights, --seed: what a light field's error depends on.
void add_quality_options(CLI::App& command, lightfield::Settings& settings);

// "512", "2x" or "0.5x". Throws UsageError for anything else.
lightfield::PsfSize parse_psf_size(const std::string& text);

// "2%" or "0.02", above 0. Throws UsageError for anything else.
double parse_share(const std::string& text);

// "auto" (nothing) or a number from 1. Throws UsageError for anything else.
std::optional<std::uint32_t> parse_bounces(const std::string& text);

// --step-bounces: what --method links spends on a map while things move.
void add_step_bounces_option(CLI::App& command, lightfield::Settings& settings);

// --bounces auto|N.
void add_bounces_option(CLI::App& command, lightfield::Settings& settings);

}  // namespace lichtveld::commands
