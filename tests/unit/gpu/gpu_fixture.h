// A context for each test, on the device of test_device.h. Without it the tests are skipped.
#pragma once

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <glad/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>
#include <spindrift/gpu/readback_ring.h>

#include "test_device.h"

namespace spindrift::gpu {

class GpuTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto choice = testDevice();
    ASSERT_TRUE(choice) << choice.error().message;
    auto made = Context::create(*choice);
    if (!made) GTEST_SKIP() << made.error().message;
    ctx = std::move(*made);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that an error has been counted when the test looks
  }

  void TearDown() override {
    if (ctx) {
      EXPECT_THAT(ctx->takeFaults(), testing::IsEmpty()) << "missing barriers, see the log above";
      EXPECT_EQ(ctx->debugErrorCount(), expected_error_count) << "OpenGL errors, see the log above";
    }
  }

  std::unique_ptr<Context> ctx;
  std::uint64_t expected_error_count = 0;
};

}  // namespace spindrift::gpu
