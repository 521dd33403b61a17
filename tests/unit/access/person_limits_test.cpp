#include <gmock/gmock.h>

#include <spindrift/access/person_limits.h>

namespace spindrift::access {
namespace {

const PersonLimits::TimePoint kStart{std::chrono::hours(1)};

TEST(PersonLimits, APersonHasOneBudgetAndOthersHaveTheirs) {
  PersonLimits limits(2.0, 4.0);
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(limits.take("ada", kStart)) << k;
  EXPECT_FALSE(limits.take("ada", kStart));
  EXPECT_TRUE(limits.take("bob", kStart));
  EXPECT_EQ(limits.refusedCount(), 1U);
  EXPECT_TRUE(limits.take("ada", kStart + std::chrono::milliseconds(500)));
  EXPECT_FALSE(limits.take("ada", kStart + std::chrono::milliseconds(500)));
}

TEST(PersonLimits, RemembersABoundedNumberOfPeopleAndForgetsTheIdlest) {
  PersonLimits limits(1.0, 1.0);
  EXPECT_TRUE(limits.take("ada", kStart));
  for (std::size_t k = 0; k + 1 < PersonLimits::kMaxPersonCount; ++k)
    EXPECT_TRUE(limits.take(std::to_string(k), kStart + std::chrono::milliseconds(1)));
  EXPECT_FALSE(limits.take("ada", kStart + std::chrono::milliseconds(2))) << "still known";
  EXPECT_TRUE(limits.take("new", kStart + std::chrono::milliseconds(3)));
  EXPECT_EQ(limits.personCount(), PersonLimits::kMaxPersonCount);
  EXPECT_FALSE(limits.take("ada", kStart + std::chrono::milliseconds(4))) << "others were idle for longer";
}

}  // namespace
}  // namespace spindrift::access
