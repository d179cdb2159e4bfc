// The device of a test: lavapipe, which every machine has and goldens were drawn by; validated, and any message of the layers fails the test that caused it.
#pragma once

#include <gtest/gtest.h>

#include "lichtveld/gpu/device.hpp"

namespace lichtveld::testing {

class WithDevice : public ::testing::Test {
 protected:
  const gpu::Device& device() { return device_; }

  void TearDown() override {
    for (const auto& message : device_.validation_messages()) ADD_FAILURE() << "validation: " << message;
  }

 private:
  gpu::Device device_{{.device = "llvmpipe", .validation = true}};
};

}  // namespace lichtveld::testing
