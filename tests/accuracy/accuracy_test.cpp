// The quick form of `spindrift-study --suite accuracy`, one test per case.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <spindrift/study/accuracy.h>

#include "test_device.h"

namespace spindrift::study {
namespace {

class Accuracy : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Accuracy, IsWithinTolerance) {
  auto ctx = gpu::testContext();
  if (!ctx) GTEST_SKIP() << "no device: " << ctx.error().message;
  const Case& each = accuracyCases()[GetParam()];
  const auto result = each.run(**ctx, true);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_FALSE(result->rows.empty());
  bool judges = false;
  for (const Row& row : result->rows) {
    judges = judges || row.kind != Tolerance::kNone;
    EXPECT_TRUE(row.passes()) << row.name << ": " << row.measured << " " << row.unit << ", expected " << row.expected
                              << " (" << row.source << ")";
  }
  EXPECT_TRUE(judges) << "a case that cannot miss";
  EXPECT_EQ((*ctx)->debugErrorCount(), 0u) << "the driver complained; see the log";
}

INSTANTIATE_TEST_SUITE_P(Cases, Accuracy, ::testing::Range(std::size_t{0}, accuracyCases().size()),
                         [](const auto& parameter) {
                           std::string name = accuracyCases()[parameter.param].name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Cases, EndWithTheErrorOfADeviceThatIsLost) {
  auto ctx = gpu::testContext();
  if (!ctx) GTEST_SKIP() << "no device: " << ctx.error().message;
  (*ctx)->simulateLoss();
  for (const Case& each : accuracyCases()) {
    const auto result = each.run(**ctx, true);
    ASSERT_FALSE(result) << each.name << " measured something on a device that is lost";
    EXPECT_NE(result.error().message.find("lost"), std::string::npos) << each.name << ": " << result.error().message;
  }
}

TEST(Row, JudgesByItsOwnMeasure) {
  const Row relative{"r", "m", 1.04, 1.0, Tolerance::kRelative, 0.05, ""};
  EXPECT_TRUE(relative.passes());
  EXPECT_NEAR(relative.error(), 0.04, 1e-12);
  Row wrong = relative;
  wrong.measured = 1.06;
  EXPECT_FALSE(wrong.passes());
  wrong = {"a", "", 2.2, 2.0, Tolerance::kAbsolute, 0.1, ""};
  EXPECT_FALSE(wrong.passes());
  wrong = {"m", "%", 5.1, 5.0, Tolerance::kAtMost, 0.0, ""};
  EXPECT_FALSE(wrong.passes());
  wrong.measured = 5.0;
  EXPECT_TRUE(wrong.passes());
  wrong = {"l", "", 0.64, 0.65, Tolerance::kAtLeast, 0.0, ""};
  EXPECT_FALSE(wrong.passes());
  wrong.measured = 0.65;
  EXPECT_TRUE(wrong.passes());
  wrong = {"n", "", std::numeric_limits<double>::quiet_NaN(), 0.0, Tolerance::kNone, 0.0, ""};
  EXPECT_FALSE(wrong.passes()) << "what is not a number never passes";
}

}  // namespace
}  // namespace spindrift::study
