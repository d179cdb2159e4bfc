#include "lichtveld/gpu/device.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lichtveld::gpu {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr std::array device_extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};

// The instance asks for 1.3; what a device must really have is checked feature by feature, because some capture
// tools report an older version of a device that has them all.
vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation) {
  const vk::ApplicationInfo application{
      .pApplicationName = "lichtveld", .pEngineName = "lichtveld", .apiVersion = VK_API_VERSION_1_3};
  std::vector<const char*> layers, extensions;
  for (const auto& extension : context.enumerateInstanceExtensionProperties())
    if (std::strcmp(extension.extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0)
      extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  const vk::ValidationFeatureEnableEXT synchronization =
      vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &synchronization};
  if (validation) {
    const auto available = context.enumerateInstanceLayerProperties();
    if (std::none_of(available.begin(), available.end(),
                     [](const auto& layer) { return std::strcmp(layer.layerName, validation_layer) == 0; }))
      throw NoDevice(
          "validation was asked for, but the Khronos validation layer is not installed; "
          "install the package vulkan-validationlayers or leave --validation out");
    layers.push_back(validation_layer);
  }
  return {context,
          vk::InstanceCreateInfo{.pNext = validation ? &features : nullptr,
                                 .pApplicationInfo = &application,
                                 .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
                                 .ppEnabledLayerNames = layers.data(),
                                 .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                 .ppEnabledExtensionNames = extensions.data()}};
}

std::string missing_features(const vk::raii::PhysicalDevice& physical) {
  std::string missing;
  const auto want = [&](bool has, const char* what) {
    if (!has) missing += (missing.empty() ? "" : ", ") + std::string(what);
  };
  const auto extensions = physical.enumerateDeviceExtensionProperties();
  for (const char* wanted : device_extensions)
    want(std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return std::strcmp(extension.extensionName, wanted) == 0; }),
         wanted);
  const auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                              vk::PhysicalDeviceVulkan13Features>();
  const auto& core = features.get<vk::PhysicalDeviceFeatures2>().features;
  const auto& newer = features.get<vk::PhysicalDeviceVulkan13Features>();
  want(core.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
  want(core.multiViewport, "multiViewport");
  want(features.get<vk::PhysicalDeviceVulkan12Features>().shaderOutputViewportIndex,
       "shaderOutputViewportIndex");
  want(core.geometryShader, "geometryShader (a fragment's triangle number)");
  want(newer.dynamicRendering, "dynamicRendering");
  want(newer.synchronization2, "synchronization2");
  want(newer.maintenance4, "maintenance4");
  const auto can = [&](vk::Format format, vk::FormatFeatureFlags uses) {
    return (physical.getFormatProperties(format).optimalTilingFeatures & uses) == uses;
  };
  want(can(vk::Format::eR32G32B32A32Sfloat, vk::FormatFeatureFlagBits::eSampledImageFilterLinear |
                                                vk::FormatFeatureFlagBits::eColorAttachment |
                                                vk::FormatFeatureFlagBits::eStorageImage),
       "filtering and storing of 32-bit float images");
  want(can(vk::Format::eS8Uint, vk::FormatFeatureFlagBits::eDepthStencilAttachment), "8-bit stencil images");
  return missing;
}

// Samples a pixel of the A-buffer's colour and stencil images together.
std::uint32_t most_samples(const vk::raii::PhysicalDevice& physical) {
  const auto counts = [&](vk::Format format, vk::ImageUsageFlags attachment) {
    return physical
        .getImageFormatProperties(format, vk::ImageType::e2D, vk::ImageTiling::eOptimal,
                                  attachment | vk::ImageUsageFlagBits::eSampled)
        .sampleCounts;
  };
  const vk::SampleCountFlags both =
      counts(vk::Format::eR32G32B32A32Sfloat, vk::ImageUsageFlagBits::eColorAttachment) &
      counts(vk::Format::eS8Uint, vk::ImageUsageFlagBits::eDepthStencilAttachment);
  // The mask's highest bit is the highest count.
  return std::bit_floor(static_cast<std::uint32_t>(static_cast<VkSampleCountFlags>(both)));
}

DeviceSummary summarise(const vk::raii::PhysicalDevice& physical) {
  const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties,
                                             vk::PhysicalDeviceSubgroupProperties>();
  const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const auto& limits = properties.limits;
  DeviceSummary summary;
  summary.name = properties.deviceName.data();
  summary.type = vk::to_string(properties.deviceType);
  summary.driver = std::string(driver.driverName.data()) + ", " + driver.driverInfo.data();
  summary.max_image_size = limits.maxImageDimension2D;
  summary.max_storage_buffer = limits.maxStorageBufferRange;
  summary.max_texel_buffer = limits.maxTexelBufferElements;
  summary.max_groups = limits.maxComputeWorkGroupCount[0];
  summary.subgroup_size = chain.get<vk::PhysicalDeviceSubgroupProperties>().subgroupSize;
  const auto memory = physical.getMemoryProperties();
  for (const auto& heap : std::span(memory.memoryHeaps.data(), memory.memoryHeapCount))
    if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal) summary.memory += heap.size;
  summary.storage_16_bit =
      physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features>()
          .get<vk::PhysicalDeviceVulkan11Features>()
          .storageBuffer16BitAccess;
  summary.missing = missing_features(physical);
  if (summary.missing.empty()) summary.samples = most_samples(physical);
  return summary;
}

int rank(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 0;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 1;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 2;
    default:
      return 3;
  }
}

std::vector<vk::raii::PhysicalDevice> ordered_devices(const vk::raii::Instance& instance) {
  std::vector<vk::raii::PhysicalDevice> devices;
  for (auto& device : vk::raii::PhysicalDevices(instance)) devices.push_back(std::move(device));
  std::stable_sort(devices.begin(), devices.end(), [](const auto& a, const auto& b) {
    return rank(a.getProperties().deviceType) < rank(b.getProperties().deviceType);
  });
  return devices;
}

bool matches(const DeviceSummary& summary, std::size_t index, const std::string& wanted) {
  if (wanted.empty()) return summary.missing.empty();
  if (wanted.find_first_not_of("0123456789") == std::string::npos) return wanted == std::to_string(index);
  return summary.name.find(wanted) != std::string::npos;
}

vk::raii::PhysicalDevice choose(const vk::raii::Instance& instance, const std::string& wanted) {
  auto devices = ordered_devices(instance);
  std::string found;
  for (std::size_t index = 0; index < devices.size(); ++index) {
    const DeviceSummary summary = summarise(devices[index]);
    if (matches(summary, index, wanted)) {
      if (summary.missing.empty()) return std::move(devices[index]);
      throw NoDevice("device " + summary.name + " lacks " + summary.missing +
                     "; try another one with --device");
    }
    found += "\n  " + std::to_string(index) + ": " + summary.name +
             (summary.missing.empty() ? "" : " lacks " + summary.missing);
  }
  if (devices.empty())
    throw NoDevice("no Vulkan device: install a driver (mesa-vulkan-drivers has lavapipe, which needs no GPU)");
  throw NoDevice((wanted.empty() ? "no Vulkan device here has all that is needed:"
                                 : "no Vulkan device matches --device " + wanted + "; there are:") +
                 found);
}

std::uint32_t graphics_family(const vk::raii::PhysicalDevice& physical) {
  const auto families = physical.getQueueFamilyProperties();
  const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  for (std::uint32_t index = 0; index < families.size(); ++index)
    if ((families[index].queueFlags & wanted) == wanted) return index;
  throw NoDevice(std::string(physical.getProperties().deviceName.data()) +
                 " has no queue for graphics and compute");
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::PhysicalDeviceFeatures core{.geometryShader = true,  // gl_PrimitiveID in fragment shaders
                                        .multiViewport = true,
                                        .fragmentStoresAndAtomics = true};
  const bool storage_16_bit = summarise(physical).storage_16_bit;
  const vk::PhysicalDeviceVulkan11Features newer_11{.storageBuffer16BitAccess = storage_16_bit};
  const vk::PhysicalDeviceVulkan12Features newer_12{
      .pNext = const_cast<vk::PhysicalDeviceVulkan11Features*>(&newer_11), .shaderOutputViewportIndex = true};
  const vk::PhysicalDeviceVulkan13Features newer{
      .pNext = const_cast<vk::PhysicalDeviceVulkan12Features*>(&newer_12),
      .synchronization2 = true,
      .dynamicRendering = true,
      .maintenance4 = true};
  const vk::PhysicalDeviceFeatures2 features{.pNext = const_cast<vk::PhysicalDeviceVulkan13Features*>(&newer),
                                             .features = core};
  return {physical,
          vk::DeviceCreateInfo{.pNext = &features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue,
                               .enabledExtensionCount = static_cast<std::uint32_t>(device_extensions.size()),
                               .ppEnabledExtensionNames = device_extensions.data()}};
}

NoDevice unusable(const vk::SystemError& error) {
  return NoDevice(std::string("no Vulkan device can be used (") + error.what() +
                  "): install a driver (mesa-vulkan-drivers has lavapipe, which needs no GPU)");
}

}  // namespace

std::vector<DeviceSummary> list_devices() {
  std::vector<DeviceSummary> summaries;
  try {
    const vk::raii::Context context;
    const auto instance = make_instance(context, false);
    for (const auto& device : ordered_devices(instance)) summaries.push_back(summarise(device));
  } catch (const vk::SystemError&) {
    // No driver, or none that can be initialised: the empty list says so.
  }
  return summaries;
}

void MemoryLedger::add(const std::string& name, std::uint64_t bytes) {
  bytes_[name] += bytes;
}

void MemoryLedger::remove(const std::string& name, std::uint64_t bytes) {
  const auto entry = bytes_.find(name);
  if ((entry->second -= bytes) == 0) bytes_.erase(entry);
}

DeviceSummary chosen_device(const std::string& wanted) {
  try {
    const vk::raii::Context context;
    return summarise(choose(make_instance(context, false), wanted));
  } catch (const vk::SystemError& error) {
    throw unusable(error);
  }
}

Device::Device(const DeviceOptions& options) {
  try {
    instance_ = make_instance(context_, options.validation);
    if (options.validation) {
      vk::DebugUtilsMessengerCreateInfoEXT info{
          .messageSeverity = vk::DebugUtilsMessageSeverityFlagBitsEXT::eWarning |
                             vk::DebugUtilsMessageSeverityFlagBitsEXT::eError,
          .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation |
                         vk::DebugUtilsMessageTypeFlagBitsEXT::ePerformance,
          .pUserData = messages_.get()};
      // Newer headers spell the callback's type with their own enumerations; the call is the same. By way of
      // void (*)(), which GCC takes as meant.
      info.pfnUserCallback =
          reinterpret_cast<decltype(info.pfnUserCallback)>(reinterpret_cast<void (*)()>(&Device::on_message));
      messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, info);
    }
    physical_ = choose(instance_, options.device);
    const auto family = graphics_family(physical_);
    device_ = make_device(physical_, family);
    queue_ = device_.getQueue(family, 0);
    commands_ = vk::raii::CommandPool(
        device_, {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = family});
    name(device_, "device");
    name(queue_, "queue");
    name(commands_, "frame/commands");
  } catch (const vk::SystemError& error) {
    throw unusable(error);
  }
  memory_ = physical_.getMemoryProperties();
  summary_ = summarise(physical_);
  timestamp_period_ = physical_.getProperties().limits.timestampPeriod;
}

std::uint32_t Device::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags flags) const {
  for (std::uint32_t index = 0; index < memory_.memoryTypeCount; ++index)
    if ((allowed & (1u << index)) && (memory_.memoryTypes[index].propertyFlags & flags) == flags) return index;
  throw std::runtime_error(summary_.name + " has no memory that is " + vk::to_string(flags));
}

std::vector<std::string> Device::validation_messages() const {
  const std::lock_guard lock(messages_->mutex);
  return messages_->texts;
}

VkBool32 Device::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto& messages = *static_cast<Messages*>(user);
  spdlog::error("validation: {}", data->pMessage);
  const std::lock_guard lock(messages.mutex);
  messages.texts.emplace_back(data->pMessage);
  return VK_FALSE;
}

void Device::set_name(vk::ObjectType type, std::uint64_t handle, const std::string& name) const {
  if (device_.getDispatcher()->vkSetDebugUtilsObjectNameEXT == nullptr) return;
  device_.setDebugUtilsObjectNameEXT({.objectType = type, .objectHandle = handle, .pObjectName = name.c_str()});
}

}  // namespace lichtveld::gpu
