#include "lichtveld/gpu/capture.hpp"

#include <cstdlib>
#include <utility>

#ifdef LICHTVELD_HAS_RENDERDOC_HEADER
#include <dlfcn.h>
#include <fmt/format.h>
#include <renderdoc_app.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <fstream>
#include <string>
#endif

namespace lichtveld::gpu {

#ifdef LICHTVELD_HAS_RENDERDOC_HEADER

namespace {

namespace fs = std::filesystem;

using Api = RENDERDOC_API_1_4_0;  // the first that can discard a capture

void* load() {
  const char* named = std::getenv("LICHTVELD_RENDERDOC");
  const std::string library = named != nullptr ? named : "librenderdoc.so";
  // Its Vulkan layer is asked for by this variable; it must be set when the instance is made.
  setenv("ENABLE_VULKAN_RENDERDOC_CAPTURE", "1", 1);
  // Never unloaded: RenderDoc's hooks stay in place as long as the process.
  void* handle = dlopen(library.c_str(), RTLD_NOW);
  if (handle == nullptr)
    throw CaptureError(std::string("--capture: RenderDoc cannot be loaded (") + dlerror() +
                       "); install it, on Debian the package librenderdoc, or name its library with "
                       "LICHTVELD_RENDERDOC=/path/to/librenderdoc.so");
  const auto get_api = reinterpret_cast<pRENDERDOC_GetAPI>(dlsym(handle, "RENDERDOC_GetAPI"));
  void* api = nullptr;
  if (get_api == nullptr || get_api(eRENDERDOC_API_Version_1_4_0, &api) != 1)
    throw CaptureError("--capture: " + library +
                       " is no RenderDoc, or too old a one; install the package librenderdoc");
  return api;
}

// Where RenderDoc has put the newest capture.
fs::path newest(const Api& api) {
  const auto count = api.GetNumCaptures();
  std::uint32_t length = 0;
  if (count == 0 || api.GetCapture(count - 1, nullptr, &length, nullptr) != 1) return {};
  std::string name(length, '\0');
  api.GetCapture(count - 1, name.data(), nullptr, nullptr);
  return name.c_str();  // the length counts the zero at its end
}

// RenderDoc does not say when a disk was full before all was written: then one more byte does not fit either.
bool has_room(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  std::ofstream more(file, std::ios::binary | std::ios::app);
  more.put(0).flush();
  const bool fits = !error && more.good();
  more.close();
  fs::resize_file(file, size, error);
  return fits && !error;
}

}  // namespace

Capture::Capture(fs::path file, std::uint32_t skipped)
    : file_(std::move(file)),
      template_(fs::absolute(file_).parent_path() / fmt::format(".{}.{}", file_.stem().string(), getpid())),
      skipped_(skipped),
      api_(load()) {
  const auto& api = *static_cast<Api*>(api_);
  api.SetCaptureFilePathTemplate(template_.c_str());
  api.SetCaptureKeys(nullptr, 0);
}

void Capture::around(const std::function<void()>& work) {
  if (done_ != skipped_) {
    work();
    ++done_;
    return;
  }
  const auto& api = *static_cast<Api*>(api_);
  api.StartFrameCapture(nullptr, nullptr);
  const bool captures = api.IsFrameCapturing() == 1;
  ++done_;
  try {
    work();
  } catch (...) {
    if (captures) api.DiscardFrameCapture(nullptr, nullptr);
    throw;
  }
  if (!captures)
    throw CaptureError(
        "--capture: RenderDoc does not see the Vulkan device; is its layer installed "
        "(vulkan/implicit_layer.d/renderdoc_capture.json, on Debian of the package librenderdoc)?");
  save();
}

void Capture::save() const {
  const auto& api = *static_cast<Api*>(api_);
  const bool captured = api.EndFrameCapture(nullptr, nullptr) == 1;
  const auto made = captured ? newest(api) : fs::path();
  std::error_code error;
  if (!made.empty() && has_room(made)) {
    fs::rename(made, file_, error);
    if (!error) {
      spdlog::info("{}: captured; open it with qrenderdoc", file_.string());
      return;
    }
  }
  remove_leftovers();
  throw CaptureError(file_.string() + " cannot be written" + (error ? ": " + error.message() : "") +
                     "; is there room, and may you write there?");
}

// What RenderDoc has begun is named by its template and more.
void Capture::remove_leftovers() const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(template_.parent_path(), ignored))
    if (entry.path().filename().string().starts_with(template_.filename().string()))
      fs::remove(entry.path(), ignored);
}

#else

Capture::Capture(std::filesystem::path file, std::uint32_t skipped)
    : file_(std::move(file)), skipped_(skipped) {
  throw CaptureError(
      "--capture: this executable was built without RenderDoc's header; install the package librenderdoc-dev "
      "(it holds renderdoc_app.h) and build again");
}

void Capture::around(const std::function<void()>& work) {
  work();
}

void Capture::save() const {}
void Capture::remove_leftovers() const {}

#endif

}  // namespace lichtveld::gpu
