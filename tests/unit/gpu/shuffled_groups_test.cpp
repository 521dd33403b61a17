#include "shuffled_groups.h"

#include <numeric>
#include <set>

#include <gmock/gmock.h>

namespace spindrift::gpu {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ShuffledGroups, ReplacesWholeWordsAndKeepsTheLinesOfTheText) {
  const std::string text =
      "layout(local_size_x = 8) in;\nvoid main() { uint i = gl_GlobalInvocationID.x + gl_WorkGroupID.y + "
      "gl_WorkGroupIDx; }\n";
  const std::string shuffled = shuffledGroups(text, 3);
  EXPECT_THAT(shuffled, HasSubstr("shuffledInvocation().x + shuffledGroup().y + gl_WorkGroupIDx;"));
  const std::size_t start = shuffled.find("#line 1\n");
  ASSERT_NE(start, std::string::npos);
  const std::string rest = shuffled.substr(start + 8);
  EXPECT_EQ(std::ranges::count(rest, '\n'), std::ranges::count(text, '\n'));
  EXPECT_THAT(rest, testing::StartsWith("layout"));
  EXPECT_THAT(shuffledGroups(text, 4), Not(shuffled));
}

}  // namespace
}  // namespace spindrift::gpu
