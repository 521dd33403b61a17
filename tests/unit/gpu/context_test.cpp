#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>
#include <string_view>
#include <thread>
#include <vector>

#include <EGL/egl.h>
#include <glad/gl.h>
#include <gmock/gmock.h>

#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

using ContextTest = GpuTest;

TEST_F(ContextTest, MeetsTheMinimumLimitsOfOpenGl45) {
  const DeviceInfo& device = ctx->device();
  EXPECT_THAT(device.name, Not(IsEmpty()));
  EXPECT_THAT(device.problem, IsEmpty());
  EXPECT_GE(device.limits.max_ssbo_bytes, 1 << 24);
  EXPECT_GE(device.limits.max_texel_buffer_elements, 65536);
  EXPECT_GE(device.limits.max_uniform_block_bytes, 16384);
  EXPECT_GE(device.limits.max_work_group_invocations, 1024);
  EXPECT_GE(device.limits.max_work_group_count_x, 65535);
  EXPECT_GE(device.limits.max_work_group_count_y, 65535);
  EXPECT_GE(device.limits.max_work_group_count_z, 65535);
  EXPECT_GE(device.limits.max_shared_memory_bytes, 32768);
  EXPECT_GE(device.limits.max_ssbo_bindings, 8);
  EXPECT_GE(device.limits.max_compute_ssbo_blocks, 8);
  EXPECT_GE(device.limits.max_compute_texture_units, 16);
}

TEST_F(ContextTest, SaysWhichDeviceItChoseInOneLine) {
  EXPECT_THAT(ctx->why(), HasSubstr(ctx->device().name));
  EXPECT_THAT(ctx->why(), Not(HasSubstr("\n")));
}

TEST_F(ContextTest, SoftwareMeansARendererWithoutHardware) {
  const auto software = Context::create({DeviceChoice::Kind::kSoftware, 0});
  if (!software) GTEST_SKIP() << software.error().message;
  EXPECT_TRUE((*software)->device().is_software);
  EXPECT_EQ((*software)->device().index, -1);
}

TEST_F(ContextTest, SoftwareContextsComputeSideBySide) {
  const char* const threads = std::getenv("LP_NUM_THREADS");
  if (!threads || std::string_view(threads) != "0") GTEST_SKIP() << "needs LP_NUM_THREADS=0";
  // Mesa carries out one dispatch at a time per display.
  std::vector<std::unique_ptr<Context>> contexts;
  std::set<EGLDisplay> displays;
  for (int k = 0; k < 4; ++k) {
    auto context = Context::create({DeviceChoice::Kind::kSoftware, 0});
    ASSERT_TRUE(context) << context.error().message;
    contexts.push_back(*std::move(context));
    displays.insert(eglGetCurrentDisplay());
  }
  EXPECT_EQ(displays.size(), contexts.size());
}

TEST_F(ContextTest, SecondContextDoesNotDamageTheFirst) {
  {
    auto second = Context::create(*testDevice());
    ASSERT_TRUE(second);
    EXPECT_FALSE(ctx->isOwnedHere());
    EXPECT_TRUE((*second)->isOwnedHere());
    ASSERT_TRUE(ctx->makeCurrent());
    EXPECT_FALSE((*second)->isOwnedHere());
    second->reset();
    EXPECT_TRUE(ctx->isOwnedHere()) << "destroying the second unbound the first";
  }
  glEnable(GL_TEXTURE_BUFFER);  // not a valid capability: the first context's callback must still report it
  ctx->finish();
  expected_error_count = 1;
}

TEST_F(ContextTest, DebugCallbackCountsErrors) {
  EXPECT_EQ(ctx->debugErrorCount(), 0u);
  glEnable(GL_TEXTURE_BUFFER);  // not a valid capability
  ctx->finish();
  EXPECT_EQ(ctx->debugErrorCount(), 1u);
  expected_error_count = 1;
}

TEST_F(ContextTest, DebugCallbackCountsErrorsOnly) {
  const char text[] = "a remark";
  glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_PERFORMANCE, 7, GL_DEBUG_SEVERITY_LOW, -1, text);
  ctx->finish();
  EXPECT_EQ(ctx->debugErrorCount(), 0u);
}

TEST_F(ContextTest, MovesToAnotherThreadAndBack) {
  EXPECT_TRUE(ctx->isOwnedHere());
  ctx->release();
  EXPECT_FALSE(ctx->isOwnedHere());
  bool was_taken = false;
  std::uint64_t bytes_there = 0;
  std::thread other([&] {
    was_taken = ctx->makeCurrent();
    if (!was_taken) return;
    {
      const auto buffer = Buffer::create(*ctx, "there", 12);
      if (buffer) bytes_there = ctx->ledger().buffer_bytes;
    }
    ctx->release();
  });
  other.join();
  EXPECT_TRUE(was_taken);
  EXPECT_EQ(bytes_there, 12u);
  ASSERT_TRUE(ctx->makeCurrent());
  EXPECT_EQ(ctx->ledger().buffer_bytes, 0u);
}

TEST_F(ContextTest, CannotBeTakenFromAThreadThatHoldsIt) {
  bool was_taken = true;
  std::thread other([&] { was_taken = ctx->makeCurrent(); });
  other.join();
  EXPECT_FALSE(was_taken);
  EXPECT_TRUE(ctx->isOwnedHere());
}

TEST_F(ContextTest, ListingDevicesLeavesTheContextCurrent) {
  const std::vector<DeviceInfo> devices = collectInfo(*testDevice()).devices;
  EXPECT_TRUE(std::any_of(devices.begin(), devices.end(), [&](const DeviceInfo& device) {
    return device.name == ctx->device().name && device.problem.empty();
  }));
  const auto buffer = Buffer::create(*ctx, "after", 4);
  ASSERT_TRUE(buffer);
  EXPECT_TRUE(glIsBuffer(buffer->id()));
}

TEST_F(ContextTest, InfoAgreesWithTheContext) {
  const GpuInfo info = collectInfo(*testDevice());
  ASSERT_TRUE(info.chosen);
  EXPECT_EQ(info.chosen->name, ctx->device().name);
  EXPECT_EQ(info.chosen->gl_version, ctx->device().gl_version);
  EXPECT_EQ(info.why, ctx->why());
  EXPECT_GT(info.shader_count, 0u);
  EXPECT_NE(glGetString(GL_RENDERER), nullptr) << "the context is no longer current";
}

TEST_F(ContextTest, RefusesAnIndexThatDoesNotExist) {
  const auto none = Context::create({DeviceChoice::Kind::kIndex, 1000});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, core::ErrorCode::kNoDevice);
  EXPECT_THAT(none.error().message, HasSubstr("device 1000 does not exist"));
}

}  // namespace
}  // namespace spindrift::gpu
