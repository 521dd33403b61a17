// Shaders read from a folder, and read again when they change.
#include "shader_folder.h"

#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

#include <spindrift/gpu/program.h>

#include "gpu_fixture.h"
#include "temporary_folder.h"

namespace spindrift::gpu {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// A copy of the repository's shaders that tests may change.
class ShaderFolderTest : public testing::Test {
 protected:
  void SetUp() override { fs::copy(fs::path(SPINDRIFT_SOURCE_DIR) / "shaders", root(), fs::copy_options::recursive); }

  [[nodiscard]] fs::path root() const { return folder_.path() / "shaders"; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(root() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root() / name) << text;
    // Makes this version newer than the one before at any resolution of the file system's clock.
    fs::last_write_time(root() / name, fs::last_write_time(root() / name) + std::chrono::seconds(++write_count_));
  }
  void replace(const std::string& name, const std::string& before, const std::string& after) const {
    std::string text = read(name);
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << before;
    write(name, text.replace(at, before.size(), after));
  }

  test::TemporaryFolder folder_;
  mutable int write_count_ = 0;
};

TEST_F(ShaderFolderTest, ExpandsEveryEntryPointToWhatTheBuildEmbeds) {
  const ShaderFolder shaders(root());
  const auto words = [](std::string_view text) {
    // Guards and dropped lines differ: compare without directives.
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view line = text.substr(at, end - at);
      if (line.find_first_not_of(" \t") != std::string_view::npos && !line.starts_with('#')) out.append(line) += '\n';
      at = end + 1;
    }
    return out;
  };
  // Without includes both are the same to the letter.
  const auto plain = shaders.expand("tests/iota.comp");
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(words(plain->text), words(findShader("tests/iota.comp")->text));
  for (const EmbeddedShader& shader : embeddedShaders()) {
    const auto expanded = shaders.expand(shader.path);
    ASSERT_TRUE(expanded) << expanded.error().message;
    EXPECT_TRUE(expanded->files.contains(std::string(shader.path)));
    for (const LineRange& range : shader.lines) EXPECT_TRUE(expanded->files.contains(std::string(range.file)));
  }
}

TEST_F(ShaderFolderTest, MissingIncludeIsReportedWithFileAndLine) {
  write("tests/iota.comp", "// first\n#include \"tests/nothere.glsl\"\n");
  const auto expanded = ShaderFolder(root()).expand("tests/iota.comp");
  ASSERT_FALSE(expanded);
  EXPECT_THAT(expanded.error().message, HasSubstr("tests/iota.comp:2: no file \"tests/nothere.glsl\""));
}

TEST_F(ShaderFolderTest, RefusesACycle) {
  write("tests/block.glsl", "#include \"tests/texel_equals_storage.comp\"\n");
  const auto expanded = ShaderFolder(root()).expand("tests/texel_equals_storage.comp");
  ASSERT_FALSE(expanded);
  EXPECT_THAT(expanded.error().message, HasSubstr("cycle"));
}

class LiveShader : public ShaderFolderTest {
 protected:
  void SetUp() override {
    ShaderFolderTest::SetUp();
    DeviceChoice choice;
    choice.kind = DeviceChoice::Kind::kSoftware;
    choice.shader_folder = root().string();
    auto made = Context::create(choice);
    if (!made) GTEST_SKIP() << made.error().message;
    ctx_ = *std::move(made);
  }
  /// Value that tests/iota.comp writes for item 3 with offset 5.
  std::int32_t fourth(Program& program) {
    auto values = Buffer::create(*ctx_, "values", 4 * 32);
    auto counts = Buffer::create(*ctx_, "counts", 8);
    EXPECT_TRUE(values && counts);
    values->bindStorage(0);
    counts->bindStorage(1);
    program.setUniform("item_count", 32U);
    program.setUniform("offset", 5);
    EXPECT_TRUE(program.dispatch(32));
    return values->downloadVector<std::int32_t>(32)[3];
  }
  /// Calls it repeatedly, like once per tick, until the folder was checked again.
  void waitForALook() {
    std::this_thread::sleep_for(std::chrono::milliseconds(350));
    ctx_->reloadChangedShaders();
  }

  std::unique_ptr<Context> ctx_;
};

TEST_F(LiveShader, RunsTheChangedFileAndKeepsItsUniforms) {
  auto program = Program::create(*ctx_, "tests/iota.comp", {{"GROUP", "32"}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(fourth(*program), 8);
  replace("tests/iota.comp", "+ offset", "+ 2 * offset");
  waitForALook();
  EXPECT_EQ(fourth(*program), 13);
  EXPECT_EQ(ctx_->debugErrorCount(), 0u);
}

TEST_F(LiveShader, KeepsTheOldProgramOnACompileError) {
  auto program = Program::create(*ctx_, "tests/iota.comp", {{"GROUP", "32"}});
  ASSERT_TRUE(program) << program.error().message;
  replace("tests/iota.comp", "+ offset", "+ no_such_name");
  waitForALook();
  EXPECT_EQ(fourth(*program), 8);
  const auto again = Program::create(*ctx_, "tests/iota.comp", {{"GROUP", "16"}});
  ASSERT_FALSE(again) << "a new program is compiled from the file as it is";
  EXPECT_THAT(again.error().message, HasSubstr("tests/iota.comp:"));
  EXPECT_THAT(again.error().message, HasSubstr("no_such_name"));
  replace("tests/iota.comp", "+ no_such_name", "+ 3 * offset");
  waitForALook();
  EXPECT_EQ(fourth(*program), 18);
}

}  // namespace
}  // namespace spindrift::gpu
