#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "command_list.hpp"
#include "lichtveld/commands/commands.hpp"
#include "lichtveld/files/output.hpp"
#include "options.hpp"
#include "progress_shown.hpp"
#include "version.hpp"

namespace lichtveld::commands {

namespace {

enum Status { fine = 0, failed = 1, bad_usage = 2, no_device = 3 };

int parse_and_run(CLI::App& application, int argc, char** argv) {
  try {
    application.parse(argc, argv);
    return fine;
  } catch (const CLI::Success& help) {
    return application.exit(help);
  } catch (const CLI::ParseError& error) {
    spdlog::error("{}; see lichtveld --help", error.what());
    return bad_usage;
  } catch (const UsageError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const files::OutputError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const scene::SceneError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const std::invalid_argument& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const gpu::NoDevice& error) {
    spdlog::error("{}", error.what());
    return no_device;
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory; try a smaller --size or --psf, or a simpler scene");
    return failed;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return failed;
  }
}

}  // namespace

int run(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("lichtveld"));
  spdlog::set_pattern("%^%l%$: %v");
  CLI::App application("Shared diffuse global illumination by virtual light fields", "lichtveld");
  application.require_subcommand(1);
  application.set_version_flag("--version", version, "Version, commit, device and libraries");
  application.set_help_all_flag("--help-all", "The help of every command");
  add_bake(application);
  add_serve(application);
  add_unwrap(application);
  add_bench(application);
  add_check(application);
  add_info(application);
  const ProgressShown shown;
  return parse_and_run(application, argc, argv);
}

}  // namespace lichtveld::commands
