#include <gmock/gmock.h>

#include <spindrift/gpu/pass_timer.h>
#include <spindrift/gpu/program.h>

#include "gpu_fixture.h"

namespace spindrift::gpu {
namespace {

class PassTimersTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!ctx) return;
    auto made = Program::create(*ctx, "tests/iota.comp", {{"GROUP", "64"}});
    auto v = Buffer::create(*ctx, "values", 4 * kCount);
    auto c = Buffer::create(*ctx, "counts", 8);
    ASSERT_TRUE(made && v && c);
    program = std::move(*made);
    values = std::move(*v);
    counts = std::move(*c);
    values.bindStorage(0);
    counts.bindStorage(1);
    program.setUniform("item_count", kCount);
  }
  void TearDown() override {
    program = Program();
    values = Buffer();
    counts = Buffer();
    GpuTest::TearDown();
  }

  static constexpr std::uint32_t kCount = 1 << 16;
  Program program;
  Buffer values;
  Buffer counts;
};

TEST_F(PassTimersTest, SumOfScopesStaysWithinTheOuterScope) {
  PassTimers timers(*ctx);
  {
    const auto step = timers.scope("step");
    for (int i = 0; i < 3; ++i) {
      const auto grid = timers.scope("grid");
      ASSERT_TRUE(program.dispatch(kCount));
      ctx->barrier(Barrier::kStorage);
    }
    const auto sph = timers.scope("sph");
    ASSERT_TRUE(program.dispatch(kCount));
  }
  ctx->finish();
  const auto costs = timers.take();
  ASSERT_EQ(costs.size(), 3u);
  EXPECT_EQ(costs[0].name, "step");
  EXPECT_EQ(costs[1].name, "grid");
  EXPECT_EQ(costs[1].scope_count, 3u);
  EXPECT_EQ(costs[2].name, "sph");
  EXPECT_EQ(costs[2].scope_count, 1u);
  EXPECT_GT(costs[1].total_ms, 0.0);
  EXPECT_GT(costs[2].total_ms, 0.0);
  // All three are timestamps of the device, so that no other clock has to agree.
  EXPECT_LE(costs[1].total_ms + costs[2].total_ms, costs[0].total_ms + 1e-9);
  EXPECT_EQ(timers.droppedCount(), 0u);
}

TEST_F(PassTimersTest, TakeStartsAfresh) {
  PassTimers timers(*ctx);
  {
    const auto scope = timers.scope("wave");
    ASSERT_TRUE(program.dispatch(kCount));
  }
  ctx->finish();
  EXPECT_EQ(timers.take().size(), 1u);
  EXPECT_TRUE(timers.take().empty());
}

TEST_F(PassTimersTest, DropsScopesBeyondItsRingAndCountsThem) {
  PassTimers timers(*ctx, 2);
  {
    const auto first = timers.scope("open");
    const auto second = timers.scope("open");
    const auto third = timers.scope("open");  // both queries are taken by scopes that are still open
  }
  EXPECT_EQ(timers.droppedCount(), 1u);
  ctx->finish();
  const auto costs = timers.take();
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].scope_count, 2u);
}

TEST_F(PassTimersTest, ReusesItsRing) {
  PassTimers timers(*ctx, 4);
  for (int i = 0; i < 50; ++i) {
    {
      const auto scope = timers.scope("pass");
      ASSERT_TRUE(program.dispatch(64));
      ctx->barrier(Barrier::kStorage);
    }
    ctx->finish();
  }
  EXPECT_EQ(timers.droppedCount(), 0u);
  const auto costs = timers.take();
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].scope_count, 50u);
}

}  // namespace
}  // namespace spindrift::gpu
