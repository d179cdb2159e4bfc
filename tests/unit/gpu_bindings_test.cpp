// What a pass binds is held against its compiled shaders. The shaders stand in tests/unit/shaders.
#include <gmock/gmock.h>

#include <functional>

#include "device_for_tests.hpp"
#include "lichtveld/gpu/transfer.hpp"
#include "shaders/every_kind.comp.h"
#include "shaders/other_constants.frag.h"
#include "shaders/other_name.frag.h"
#include "shaders/plain.frag.h"
#include "shaders/uniform_buffer.comp.h"
#include "shaders/whole.vert.h"
#include "shaders/writing.frag.h"

namespace lichtveld::gpu {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr auto storage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst;
constexpr auto colour = vk::Format::eR8G8B8A8Unorm;

// What `act` throws; empty if it throws nothing.
std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

class Bindings : public testing::WithDevice {
 protected:
  struct Constants {
    std::uint32_t added, unused;
  };
  struct Colour {
    float rgba[4];
  };

  // In another order than the shader's.
  std::vector<Binding> right() const {
    return {sampled("seen", seen_, sampler_), fetches("fetched", fetched_), writes("kept", kept_),
            reads("given", given_),           reads("Numbers", numbers_),   writes("Sums", sums_)};
  }
  // right(), but `changed` in the place of the binding of its name.
  std::vector<Binding> with(const Binding& changed) const {
    auto bindings = right();
    for (auto& binding : bindings)
      if (binding.name == changed.name) binding = changed;
    return bindings;
  }
  std::string refusal_of(const std::vector<Binding>& bindings) {
    return message_of([&] { frame_.compute(every_kind_, bindings, Constants{}, 1, 1); });
  }

  void clear_all() {
    for (const auto* buffer : {&numbers_, &fetched_}) frame_.clear("clear", *buffer, 10);
    for (const auto* image : {&given_, &kept_, &seen_})
      frame_.clear("clear", *image, vk::ClearColorValue(std::array{100u, 0u, 0u, 0u}));
  }

  Image image(const std::string& name) {
    return {device(),
            name,
            {.width = 4},
            vk::Format::eR32Uint,
            vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled |
                vk::ImageUsageFlagBits::eTransferDst};
  }

  const ComputePipeline every_kind_{device(), "every_kind", shaders::every_kind_comp};
  const Buffer sums_{device(), "test/sums", 16, storage, Memory::host};
  const Buffer numbers_{device(), "test/numbers", 16, storage};
  const Buffer fetched_{device(), "test/fetched", 16, storage, Memory::device, vk::Format::eR32Uint};
  const Image given_ = image("test/given"), kept_ = image("test/kept"), seen_ = image("test/seen");
  const vk::raii::Sampler sampler_{device().handle(), vk::SamplerCreateInfo{}};
  const Image drawn_{
      device(), "test/drawn", {.width = 4, .height = 4}, colour, vk::ImageUsageFlagBits::eColorAttachment};
  Frame frame_{device()};

  GraphicsPipeline whole(const Shader& fragment) {
    return {device(), "whole", shaders::whole_vert, fragment, {.colours = {colour}}};
  }
  // Of one pass that lists these and records so.
  std::string refusal_of_pass(const std::vector<Binding>& listed, const std::function<void(Draw&)>& draw) {
    return message_of([&] {
      frame_.render("whole", {.extent = drawn_.extent(), .colours = {{&drawn_, vk::ClearValue{}}}}, listed, {},
                    draw);
    });
  }
};

TEST_F(Bindings, AreWhatTheShaderDeclares) {
  const auto& interface = every_kind_.interface();
  EXPECT_EQ(interface.shaders, "every_kind.comp");
  EXPECT_EQ(interface.push_bytes, sizeof(Constants));
  std::vector<std::string> slots;
  for (const auto& slot : interface.slots)
    slots.push_back(std::to_string(slot.binding) + " " + slot.name + (slot.writable ? " w" : " r") +
                    std::to_string(static_cast<int>(slot.kind)));
  EXPECT_THAT(slots,
              ElementsAre("0 Sums w2", "2 Numbers r2", "3 given r1", "4 kept w1", "5 fetched r3", "7 seen r0"));
}

TEST_F(Bindings, AreMatchedByNameInAnyOrder) {
  clear_all();
  EXPECT_EQ(refusal_of(right()), "");
  frame_.compute(every_kind_, right(), Constants{.added = 1000, .unused = 0}, 1, 1);
  frame_.to_host(sums_);
  frame_.submit_and_wait();
  // numbers, given, kept and one more of the pass before, fetched, seen, added
  EXPECT_THAT(sums_.as<std::uint32_t>(), ::testing::Each(10 + 100 + 101 + 10 + 100 + 1000));
}

TEST_F(Bindings, ANameThatTheShaderLacksIsRefused) {
  auto bindings = right();
  bindings.push_back(reads("More", numbers_));
  EXPECT_THAT(refusal_of(bindings), AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"More\""),
                                          HasSubstr("not in the shader"), HasSubstr("test/numbers")));
}

TEST_F(Bindings, AMissingOneIsRefused) {
  auto bindings = right();
  bindings.pop_back();
  EXPECT_THAT(refusal_of(bindings),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Sums\""), HasSubstr("is missing")));
  EXPECT_THAT(refusal_of({}), AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Sums\""), HasSubstr("nothing")));
}

TEST_F(Bindings, OneThatIsGivenTwiceIsRefused) {
  auto bindings = right();
  bindings.push_back(bindings.back());
  EXPECT_THAT(refusal_of(bindings),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Sums\""), HasSubstr("twice")));
  bindings = right();
  bindings.back() = reads("Numbers", sums_);  // as many as the shader has, and another one missing
  EXPECT_THAT(refusal_of(bindings),
              AllOf(HasSubstr("\"Numbers\""), HasSubstr("twice"), HasSubstr("test/sums")));
}

TEST_F(Bindings, AnotherKindIsRefused) {
  EXPECT_THAT(refusal_of(with(fetches("Numbers", fetched_))),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Numbers\" is a storage buffer"),
                    HasSubstr("texel buffer test/fetched")));
  EXPECT_THAT(refusal_of(with(reads("fetched", fetched_))), HasSubstr("\"fetched\" is a texel buffer"));
  EXPECT_THAT(refusal_of(with(reads("seen", seen_))), HasSubstr("\"seen\" is a sampled image"));
  EXPECT_THAT(refusal_of(with(sampled("given", given_, sampler_))), HasSubstr("\"given\" is a storage image"));
}

TEST_F(Bindings, ReadingWhatTheShaderMayWriteIsRefused) {
  EXPECT_THAT(refusal_of(with(reads("Sums", sums_))),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Sums\""), HasSubstr("reads()")));
  EXPECT_THAT(refusal_of(with(reads("kept", kept_))), AllOf(HasSubstr("\"kept\""), HasSubstr("reads()")));
}

TEST_F(Bindings, WritingWhatTheShaderOnlyReadsIsRefused) {
  EXPECT_THAT(refusal_of(with(writes("Numbers", numbers_))),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"Numbers\""), HasSubstr("writes()")));
  EXPECT_THAT(refusal_of(with(writes("given", given_))), AllOf(HasSubstr("\"given\""), HasSubstr("writes()")));
}

TEST_F(Bindings, TexelsOfABufferWithoutAFormatAreRefused) {
  EXPECT_THAT(refusal_of(with(fetches("fetched", numbers_))),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("\"fetched\""), HasSubstr("test/numbers")));
}

TEST_F(Bindings, PushConstantsOfAnotherSizeAreRefused) {
  EXPECT_THAT(message_of([&] { frame_.compute(every_kind_, right(), 1u, 1, 1); }),
              AllOf(HasSubstr("every_kind.comp"), HasSubstr("8 bytes"), HasSubstr("4 were given")));
  EXPECT_THAT(message_of([&] { frame_.compute(every_kind_, right(), 1, 1); }), HasSubstr("0 were given"));
}

TEST_F(Bindings, WhatNoPipelineBindsIsRefused) {
  EXPECT_THAT(message_of([&] { ComputePipeline(device(), "test", shaders::uniform_buffer_comp); }),
              AllOf(HasSubstr("uniform_buffer.comp"), HasSubstr("\"Settings\"")));
}

TEST_F(Bindings, OfBothShadersAreOneInterface) {
  const auto pipeline = whole(shaders::plain_frag);
  const std::vector bindings = {writes("Count", sums_), reads("Depths", numbers_)};
  frame_.clear("clear", sums_);
  frame_.clear("clear", numbers_);
  EXPECT_EQ(refusal_of_pass(bindings,
                            [&](Draw& draw) {
                              draw.bind(pipeline, bindings);
                              draw.push(Colour{});
                              draw.full_screen_triangle();
                            }),
            "");
  frame_.to_host(sums_);
  frame_.submit_and_wait();
  EXPECT_EQ(sums_.as<std::uint32_t>().front(), 16u);  // pixels
}

TEST_F(Bindings, WhatEitherShaderWritesIsWritten) {
  const auto pipeline = whole(shaders::writing_frag);
  ASSERT_EQ(pipeline.interface().slots.size(), 1u);
  EXPECT_TRUE(pipeline.interface().slots.front().writable);
}

TEST_F(Bindings, ShadersOfOnePipelineMustAgree) {
  EXPECT_THAT(
      message_of([&] { whole(shaders::other_name_frag); }),
      AllOf(HasSubstr("whole.vert + other_name.frag"), HasSubstr("\"Depths\""), HasSubstr("\"Colours\"")));
  EXPECT_THAT(message_of([&] { whole(shaders::other_constants_frag); }),
              AllOf(HasSubstr("whole.vert + other_constants.frag"), HasSubstr("16 bytes"), HasSubstr("20")));
}

TEST_F(Bindings, OfADrawAreChecked) {
  const auto pipeline = whole(shaders::plain_frag);
  const std::vector bindings = {writes("Count", sums_), reads("Depths", numbers_)};
  EXPECT_THAT(refusal_of_pass(bindings, [&](Draw& draw) { draw.bind(pipeline, {bindings[0]}); }),
              AllOf(HasSubstr("whole.vert + plain.frag"), HasSubstr("\"Depths\""), HasSubstr("missing")));
}

TEST_F(Bindings, OfADrawMustBeListedByItsPass) {
  const auto pipeline = whole(shaders::plain_frag);
  const std::vector bindings = {writes("Count", sums_), reads("Depths", numbers_)};
  const auto bind = [&](Draw& draw) { draw.bind(pipeline, bindings); };
  EXPECT_THAT(refusal_of_pass({bindings[1]}, bind),
              AllOf(HasSubstr("whole.vert + plain.frag"), HasSubstr("\"Count\""), HasSubstr("not listed")));
}

TEST_F(Bindings, ADrawWhosePassListsAsReadWhatItWritesIsRefused) {
  const auto pipeline = whole(shaders::plain_frag);
  const std::vector bindings = {writes("Count", sums_), reads("Depths", numbers_)};
  const auto bind = [&](Draw& draw) { draw.bind(pipeline, bindings); };
  EXPECT_THAT(refusal_of_pass({reads("Count", sums_), bindings[1]}, bind), HasSubstr("not listed"));
}

TEST_F(Bindings, ADrawWithoutItsConstantsIsRefused) {
  const auto pipeline = whole(shaders::plain_frag);
  const std::vector bindings = {writes("Count", sums_), reads("Depths", numbers_)};
  const auto draws = [&](Draw& draw) {
    draw.bind(pipeline, bindings);
    draw.full_screen_triangle();
  };
  EXPECT_THAT(refusal_of_pass(bindings, draws),
              AllOf(HasSubstr("whole.vert + plain.frag"), HasSubstr("16 bytes")));
}

}  // namespace
}  // namespace lichtveld::gpu
