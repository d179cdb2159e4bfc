// The Vulkan device that everything runs on: chosen, made, and asked about its limits.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "lichtveld/gpu/times.hpp"

namespace lichtveld::gpu {

// No Vulkan device here can do the work. The message lists what was found and what to try.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct DeviceOptions {
  std::string device;       // an index of list_devices() or a part of a name; empty: a real GPU before a CPU
  bool validation = false;  // validation layers, synchronization validation included; messages are collected
};

// What `lichtveld info` prints about one device.
struct DeviceSummary {
  std::string name, type, driver;  // driver: name and version, as goldens are kept by
  std::uint32_t samples = 1;       // most samples a pixel for colour and stencil at once: layers a routed pass
  std::uint32_t max_image_size = 0;                  // texels a side
  std::uint64_t max_storage_buffer = 0, memory = 0;  // bytes
  std::uint64_t max_texel_buffer = 0;                // texels
  std::uint32_t max_groups = 0;                      // workgroups of a dispatch, in x
  std::uint32_t subgroup_size = 0;
  bool storage_16_bit = false;  // storage buffers of 16-bit values
  std::string missing;          // empty, or the features we need that it lacks
};

// Every Vulkan device, in the order in which they would be chosen. Empty if there is none.
std::vector<DeviceSummary> list_devices();

// The one that Device would take for DeviceOptions::device. Throws NoDevice as it does.
DeviceSummary chosen_device(const std::string& wanted);

// How much memory each living buffer and image of the device holds, by name, and what the host keeps of that
// size.
class MemoryLedger {
 public:
  void add(const std::string& name, std::uint64_t bytes);
  void remove(const std::string& name, std::uint64_t bytes);
  const std::map<std::string, std::uint64_t>& bytes_by_name() const { return bytes_; }

 private:
  std::map<std::string, std::uint64_t> bytes_;
};

class Device {
 public:
  // Throws NoDevice if nothing fits `options`, or if validation is asked for and its layer is not installed.
  explicit Device(const DeviceOptions& options = {});

  const vk::raii::Device& handle() const { return device_; }
  const vk::raii::Queue& queue() const { return queue_; }
  const vk::raii::CommandPool& commands() const { return commands_; }
  const DeviceSummary& summary() const { return summary_; }
  float timestamp_period() const { return timestamp_period_; }  // ns a tick
  std::shared_ptr<MemoryLedger> ledger() const { return ledger_; }
  TimeLedger& times() const { return *times_; }  // for the thread that uses the device

  // An index of a memory type among `allowed` (a mask) that has all of `flags`. Throws if there is none.
  std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const;

  // Gives a Vulkan object its name in captures and validation messages.
  template <typename Handle>
  void name(const Handle& object, const std::string& name) const {
    set_name(Handle::objectType, reinterpret_cast<std::uint64_t>(static_cast<typename Handle::CType>(*object)),
             name);
  }

  // What the validation layers have said so far (warnings and errors). Any is a programmer's error.
  std::vector<std::string> validation_messages() const;

 private:
  struct Messages {
    std::mutex mutex;
    std::vector<std::string> texts;
  };

  static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                   VkDebugUtilsMessageTypeFlagsEXT type,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                   void* user);
  void set_name(vk::ObjectType type, std::uint64_t handle, const std::string& name) const;

  std::unique_ptr<Messages> messages_ = std::make_unique<Messages>();
  std::shared_ptr<MemoryLedger> ledger_ = std::make_shared<MemoryLedger>();
  std::unique_ptr<TimeLedger> times_ = std::make_unique<TimeLedger>();
  vk::raii::Context context_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  vk::raii::PhysicalDevice physical_ = nullptr;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::CommandPool commands_ = nullptr;
  vk::PhysicalDeviceMemoryProperties memory_;
  DeviceSummary summary_;
  float timestamp_period_ = 1;
};

}  // namespace lichtveld::gpu
