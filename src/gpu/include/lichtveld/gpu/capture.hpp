// A RenderDoc capture, taken from inside: without a window no frame is ever presented, which is what RenderDoc
// waits for when it is asked from outside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>

namespace lichtveld::gpu {

// RenderDoc is not here, or has not captured. The message says what to try.
struct CaptureError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Capture {
 public:
  // Of one piece of work, after `skipped` others. Make it before the Device, which RenderDoc has to see made.
  // Its threads inherit the signals that are blocked now. Throws CaptureError if RenderDoc cannot be loaded;
  // LICHTVELD_RENDERDOC names another library than the system's.
  Capture(std::filesystem::path file, std::uint32_t skipped);

  // Does a piece of work that ends with the device at rest, and captures it if it is its turn: then the file is
  // there, whole, or it throws CaptureError when the work is done. If the work throws, nothing is left behind.
  void around(const std::function<void()>& work);

  const std::filesystem::path& file() const { return file_; }
  std::uint32_t skipped() const { return skipped_; }
  bool taken() const { return done_ > skipped_; }

 private:
  void save() const;
  void remove_leftovers() const;

  std::filesystem::path file_;
  std::filesystem::path template_;  // RenderDoc adds to it what makes a file's name
  std::uint32_t skipped_;
  std::uint32_t done_ = 0;  // pieces of work
  void* api_ = nullptr;     // RENDERDOC_API_1_4_0, which lives as long as the process
};

}  // namespace lichtveld::gpu
