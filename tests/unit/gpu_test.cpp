// Device choice, resources, frames.
#include <gmock/gmock.h>

#include "device_for_tests.hpp"
#include "lichtveld/gpu/transfer.hpp"

namespace lichtveld::gpu {
namespace {

using ::testing::HasSubstr;
using Gpu = lichtveld::testing::WithDevice;

constexpr auto transfer = vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst;

TEST(DeviceChoice, ListsWhatIsUsable) {
  const auto devices = list_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_FALSE(devices.front().name.empty());
  EXPECT_GE(devices.front().samples, 4u);  // every Vulkan device has 4 samples
  EXPECT_GE(devices.front().max_storage_buffer, 128u << 20);
}

TEST(DeviceChoice, TakesANumberOrAPartOfAName) {
  const std::string name = list_devices().front().name;
  EXPECT_EQ(Device({.device = "0"}).summary().name, name);
  EXPECT_EQ(Device({.device = name.substr(1, 4)}).summary().name, name);
}

TEST(DeviceChoice, ANumberIsNoPartOfAName) {
  EXPECT_THROW(Device({.device = "2"}), NoDevice) << "llvmpipe's name holds 256";
  EXPECT_THROW(Device({.device = "99"}), NoDevice);
}

TEST(DeviceChoice, NamesWhatThereIsWhenNothingMatches) {
  try {
    Device({.device = "no such device"});
    FAIL() << "it was found";
  } catch (const NoDevice& error) {
    EXPECT_THAT(error.what(), HasSubstr("no such device"));
    EXPECT_THAT(error.what(), HasSubstr(list_devices().front().name));
  }
}

TEST_F(Gpu, MemoryIsAccountedByNameForAsLongAsItLives) {
  {
    const Buffer buffer(device(), "test/buffer", 1000, transfer);
    const Buffer twin(device(), "test/buffer", 1000, transfer);
    EXPECT_GE(device().ledger()->bytes_by_name().at("test/buffer"), 2000u);
  }
  EXPECT_FALSE(device().ledger()->bytes_by_name().contains("test/buffer"));
}

TEST_F(Gpu, MoreTexelsThanTheDeviceAddressesAreRefusedByName) {
  const auto most = device().summary().max_texel_buffer;
  try {
    const Buffer buffer(device(), "test/texels", 4 * (most + 1), transfer, Memory::device,
                        vk::Format::eR32Uint);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("test/texels"));
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(most)));
  }
}

TEST_F(Gpu, ABufferThatShadersDoNotSeeAllOfIsRefusedByName) {
  const auto most = device().summary().max_storage_buffer;
  try {
    const Buffer buffer(device(), "test/large", most + 4, vk::BufferUsageFlagBits::eStorageBuffer);
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("test/large"));
    EXPECT_THAT(error.what(), HasSubstr("--size"));
  }
}

TEST_F(Gpu, AFramePutsBarriersBetweenDependentPasses) {
  const Buffer a(device(), "test/a", 4096, transfer), b(device(), "test/b", 4096, transfer);
  const Buffer out(device(), "test/out", 4096, transfer, Memory::host);
  Frame frame(device());
  for (std::uint32_t round = 1; round <= 3; ++round) {  // write after write, read after write, write after read
    frame.clear("fill", a, round);
    frame.copy("copy", a, b);
    frame.copy("copy", b, out);
  }
  frame.to_host(out);
  frame.submit_and_wait();
  for (const auto word : out.as<std::uint32_t>()) ASSERT_EQ(word, 3u);
  EXPECT_EQ(device().times().so_far().passes.at("fill").calls, 3u);
  EXPECT_EQ(device().times().so_far().passes.at("copy").calls, 6u);
}

TEST_F(Gpu, ManyPassesInOneFrameAreAllTimed) {
  const Buffer buffer(device(), "test/buffer", 64, transfer);
  Frame frame(device());
  for (int pass = 0; pass < 1500; ++pass) frame.clear("fill", buffer);  // more than one query pool holds
  frame.submit_and_wait();
  EXPECT_EQ(device().times().so_far().passes.at("fill").calls, 1500u);
  EXPECT_GT(device().times().so_far().passes.at("fill").gpu_ms, 0);
}

// The host goes on while the device works; what follows in another frame waits on the device.
TEST_F(Gpu, AFrameFollowsAnotherThatIsUnderWay) {
  const Buffer a(device(), "test/a", 1 << 20, transfer);
  const Buffer out(device(), "test/out", 1 << 20, transfer, Memory::host);
  Frame first(device());
  first.clear("fill", a, 7);
  first.submit();
  Frame second(device());
  second.copy("copy", a, out);
  second.to_host(out);
  second.submit_and_wait();
  for (const auto word : out.as<std::uint32_t>()) ASSERT_EQ(word, 7u);
  EXPECT_EQ(device().times().so_far().passes.count("fill"), 0u);
  first.wait();
  EXPECT_EQ(device().times().so_far().passes.at("fill").calls, 1u);
}

// As an exception would leave it.
TEST_F(Gpu, AFrameThatNobodyWaitsForIsDoneWhenItGoes) {
  const Buffer out(device(), "test/out", 1 << 20, transfer, Memory::host);
  {
    Frame frame(device());
    frame.clear("fill", out, 9);
    frame.to_host(out);
    frame.submit();
  }
  for (const auto word : out.as<std::uint32_t>()) ASSERT_EQ(word, 9u);
  EXPECT_EQ(device().times().so_far().passes.at("fill").calls, 1u);
}

TEST_F(Gpu, ImagesComeBackAsTheyWereSent) {
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6, 7, 8};
  Buffer staging(device(), "test/staging", pixels.size(), transfer, Memory::host);
  std::copy(pixels.begin(), pixels.end(), reinterpret_cast<std::uint8_t*>(staging.bytes().data()));
  const Image image(device(), "test/image", {.width = 2, .height = 1}, vk::Format::eR8G8B8A8Unorm,
                    vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferSrc |
                        vk::ImageUsageFlagBits::eTransferDst);
  Frame frame(device());
  frame.copy("upload", staging, image);
  frame.submit_and_wait();
  const auto back = download<std::array<std::uint8_t, 4>>(device(), image);
  EXPECT_EQ(back[1][3], 8);
  EXPECT_EQ(back[0][0], 1);
}

// If this fails, the layers are not on, and every other test's silence means nothing.
TEST(Validation, SeesAMissingBarrier) {
  const Device device({.device = "llvmpipe", .validation = true});
  const Buffer buffer(device, "test/raced", 64, transfer);
  const vk::raii::CommandBuffers made(device.handle(),
                                      {.commandPool = *device.commands(), .commandBufferCount = 1});
  const auto& commands = made.front();
  commands.begin({});
  commands.fillBuffer(buffer.handle(), 0, 64, 1);
  commands.fillBuffer(buffer.handle(), 0, 64, 2);
  commands.end();
  ASSERT_FALSE(device.validation_messages().empty());
  EXPECT_THAT(device.validation_messages().front(), HasSubstr("SYNC-HAZARD-WRITE-AFTER-WRITE"));
  EXPECT_THAT(device.validation_messages().front(), HasSubstr("test/raced"));
}

}  // namespace
}  // namespace lichtveld::gpu
