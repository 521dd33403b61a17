#include <algorithm>
#include <array>

#include <gmock/gmock.h>

#include <spindrift/gpu/embedded_shader.h>

namespace spindrift::gpu {
namespace {

/// Six lines: two of the entry, three of an include, one of the entry again.
const EmbeddedShader& sample() {
  static constexpr auto kLines = std::to_array<LineRange>({{1, "a.comp", 1}, {3, "b.glsl", 1}, {6, "a.comp", 4}});
  static constexpr EmbeddedShader kShader{"a.comp", "1\n2\n3\n4\n5\n6\n", kLines};
  return kShader;
}

TEST(EmbeddedShader, MapsALineToItsFileAndLine) {
  EXPECT_EQ(sourcePosition(sample(), 1), "a.comp:1");
  EXPECT_EQ(sourcePosition(sample(), 2), "a.comp:2");
  EXPECT_EQ(sourcePosition(sample(), 3), "b.glsl:1");
  EXPECT_EQ(sourcePosition(sample(), 5), "b.glsl:3");
  EXPECT_EQ(sourcePosition(sample(), 6), "a.comp:4");
  EXPECT_EQ(sourcePosition(sample(), 0), "a.comp (defines)");
}

TEST(EmbeddedShader, TranslatesTheLogsOfMesaAndNvidia) {
  EXPECT_EQ(translateLog(sample(), "0:4(12): error: `x' undeclared\n"), "b.glsl:2: error: `x' undeclared");
  EXPECT_EQ(translateLog(sample(), "0(6) : error C1503: undefined variable \"x\"\n\n0(1) : warning C7050: y\n"),
            "a.comp:4: error C1503: undefined variable \"x\"\na.comp:1: warning C7050: y");
}

TEST(EmbeddedShader, LeavesOtherLinesOfALogAlone) {
  for (const char* text : {"error: linking failed", "1:4(2): error: another source", "0:", "0:x", "0:4(", "0(4", "0"}) {
    EXPECT_EQ(translateLog(sample(), text), text);
  }
}

TEST(EmbeddedShader, IsFoundByItsExactPath) {
  const auto shaders = embeddedShaders();
  EXPECT_TRUE(
      std::is_sorted(shaders.begin(), shaders.end(), [](const auto& a, const auto& b) { return a.path < b.path; }));
  for (const EmbeddedShader& shader : shaders) EXPECT_EQ(findShader(shader.path), &shader);
  EXPECT_NE(findShader("tests/iota.comp"), nullptr);
  EXPECT_EQ(findShader("tests/iota"), nullptr);
  EXPECT_EQ(findShader(""), nullptr);
  EXPECT_EQ(findShader("zzz"), nullptr);
}

TEST(EmbeddedShader, KnowsTheOriginOfEachLineOfAnExpandedShader) {
  const EmbeddedShader* shader = findShader("tests/texel_equals_storage.comp");
  ASSERT_NE(shader, nullptr);
  const auto lineOf = [&](std::string_view text) {
    const std::size_t at = shader->text.find(text);
    return static_cast<std::uint32_t>(
        1 + std::count(shader->text.begin(), shader->text.begin() + std::ptrdiff_t(at), '\n'));
  };
  EXPECT_EQ(sourcePosition(*shader, 1), "tests/texel_equals_storage.comp:1");
  EXPECT_EQ(sourcePosition(*shader, lineOf("uniform Check")), "tests/block.glsl:2");
  EXPECT_EQ(sourcePosition(*shader, lineOf("local_size_x")), "tests/texel_equals_storage.comp:4");
}

}  // namespace
}  // namespace spindrift::gpu
