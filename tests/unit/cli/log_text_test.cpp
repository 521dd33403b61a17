#include <gtest/gtest.h>

#include "logging.h"

namespace spindrift::cli {
namespace {

TEST(LogText, FurtherLinesAreIndented) {
  EXPECT_EQ(indentLines("plain"), "plain");
  EXPECT_EQ(indentLines("room a\n12:00:00.000 error room b"), "room a\n    12:00:00.000 error room b");
  EXPECT_EQ(indentLines("shader:1: error\nshader:2: error\n"), "shader:1: error\n    shader:2: error");
}

TEST(LogText, ControlCharactersDoNotReachTheTerminal) {
  EXPECT_EQ(indentLines("a\x1b[31mb\rc"), "a[31mbc");
}

}  // namespace
}  // namespace spindrift::cli
