#include <memory>

#include <gtest/gtest.h>

#include <spindrift/core/result.h>

namespace spindrift::core {
namespace {

TEST(Result, HoldsAValueOrAnError) {
  Result<std::unique_ptr<int>> value = std::make_unique<int>(3);
  ASSERT_TRUE(value);
  EXPECT_EQ(**value, 3);
  const std::unique_ptr<int> moved = *std::move(value);
  EXPECT_EQ(*moved, 3);
  const Result<int> error = Error{ErrorCode::kNoDevice, "none"};
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "none");
  EXPECT_TRUE(Result<void>{});
  EXPECT_FALSE(Result<void>(Error{ErrorCode::kInternal, "x"}));
}

TEST(ExitCodes, AreTheDocumentedOnes) {
  EXPECT_EQ(exitCode(ErrorCode::kInvalidInput), 2);
  EXPECT_EQ(exitCode(ErrorCode::kUnavailable), 2);
  EXPECT_EQ(exitCode(ErrorCode::kNoDevice), 3);
  EXPECT_EQ(exitCode(ErrorCode::kCheckFailed), 1);
  EXPECT_EQ(exitCode(ErrorCode::kInternal), 1);
}

}  // namespace
}  // namespace spindrift::core
