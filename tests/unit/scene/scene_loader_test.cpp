#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>

#include "temporary_folder.h"

namespace spindrift::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

/// Returns the errors of a scene that must not load, one per line.
std::vector<std::string> errorsOf(const std::string& text) {
  const auto scene = parseSceneText(text, "pool.textproto");
  if (scene) {
    ADD_FAILURE() << "the scene loaded:\n" << text;
    return {};
  }
  EXPECT_EQ(scene.error().code, core::ErrorCode::kInvalidInput);
  return linesOf(scene.error().message);
}

struct BadScene {
  const char* name;
  const char* text;
  const char* where;                   ///< start of the one error line
  std::vector<const char*> must_hold;  ///< what else it says
};

class OneErrorScene : public testing::TestWithParam<BadScene> {};

TEST_P(OneErrorScene, IsReportedOnceWithItsLineFieldAndAdvice) {
  const BadScene& bad = GetParam();
  const std::vector<std::string> errors = errorsOf(bad.text);
  ASSERT_EQ(errors.size(), 1u) << testing::PrintToString(errors);
  EXPECT_THAT(errors[0], StartsWith(bad.where));
  for (const char* part : bad.must_hold) EXPECT_THAT(errors[0], HasSubstr(part));
}

const BadScene kBadScenes[] = {
    {"Syntax", "wave {\n  depth_m 1\n}\n", "pool.textproto:2:11: ", {"\":\""}},
    {"UnclosedBrace", "wave {\n  depth_m: 1\n", "pool.textproto:3:1: ", {}},
    {"UnknownField",
     "wave {\n  depth: 1\n}\n",
     "pool.textproto:2:3: ",
     {"\"depth\"", "Its fields are resolution_count, side_m,"}},
    {"UnknownPart", "wave {}\nsharks { count: 3 }\n", "pool.textproto:2:1: ", {"sharks"}},
    {"WrongType", "wave {\n  depth_m: \"deep\"\n}\n", "pool.textproto:2:12: ", {"deep"}},
    {"NegativeCount", "wave {\n  resolution_count: -64\n}\n", "pool.textproto:2:", {}},
    {"FractionalCount", "particles {\n\n  count: 2.5\n}\n", "pool.textproto:3:10: ", {"2.5"}},
    {"UnknownEnum",
     "particles {\n  boundary_x: BOUNDARY_SPONGE\n}\n",
     "pool.textproto:2:15: ",
     {"BOUNDARY_SPONGE", "Write BOUNDARY_PERIODIC, BOUNDARY_WALL."}},
    {"UnknownEnumNumber",
     "particles {\n  boundary_x: 7\n}\n",
     "pool.textproto:2:3: particles.boundary_x: 7",
     {"Boundary", "1 to 2"}},
    {"AboveRange",
     "wave {\n  depth_m: 200\n}\n",
     "pool.textproto:2:3: wave.depth_m: 200 m",
     {"maximum of 100 m", "choose 0.05 to 100 m"}},
    {"BelowRange", "gravity_mps2: -1\nwave {}\n", "pool.textproto:1:1: gravity_mps2: -1 m/s2", {"minimum of 0 m/s2"}},
    {"NotANumber",
     "wave {\n  side_m: nan\n}\n",
     "pool.textproto:2:3: wave.side_m: nan",
     {"not a finite number", "1 to 1000 m"}},
    {"Infinite", "wave {\n  side_m: inf\n}\n", "pool.textproto:2:3: wave.side_m: inf", {"not a finite number"}},
    {"MinusInfinite", "wave {\n  side_m: -inf\n}\n", "pool.textproto:2:3: wave.side_m: -inf", {"not a finite number"}},
    {"WidthOfNoWholeCells",
     "wave {\n  resolution_count: 40\n  side_m: 8\n  width_m: 3.5\n}\n",
     "pool.textproto:4:3: wave.width_m: 3.5 m is not a whole number of cells",
     {"0.2 m wide", "3.4 m or 3.6 m"}},
    {"WidthOfLessThanACell",
     "wave {\n  resolution_count: 4\n  side_m: 8\n  width_m: 0.5\n}\n",
     "pool.textproto:4:3: wave.width_m: 0.5 m is not a whole number of cells",
     {"choose 2 m"}},
    {"TooManyCells",
     "wave {\n  resolution_count: 4096\n}\n",
     "pool.textproto:2:3: wave.resolution_count: 4096 x 4096 cells",
     {"4194304 in all"}},
    {"BadName", "name: \"my pool\"\nwave {}\n", "pool.textproto:1:1: name: \"my pool\"", {"letters, digits"}},
    {"NotUtf8", "title: \"\\377\"\nwave {}\n", "pool.textproto:1:1: title: byte 0", {"UTF-8"}},
    {"NeitherWaveNorParticles", "gravity_mps2: 9.81\n", "pool.textproto:1:1: wave: missing", {"particles", "wave {}"}},
    {"CouplingWithoutWave",
     "particles {}\ncoupling {}\n",
     "pool.textproto:2:1: coupling: needs a wave",
     {"remove coupling"}},
    {"CouplingWithoutParticles",
     "wave {}\ncoupling {}\n",
     "pool.textproto:2:1: coupling: needs particles",
     {"remove coupling"}},
    {"EvenLattice",
     "wave {}\nparticles {}\ncoupling {\n lattice_count: 4\n}\n",
     "pool.textproto:4:2: coupling.lattice_count: 4",
     {"3 or 5"}},
    {"FoamWithoutParticles", "wave {}\n\nfoam {}\n", "pool.textproto:3:1: foam: needs particles", {"remove foam"}},
    {"PatchOverTheEdge",
     "wave {}\nparticles {\n  patch_scale: 0.5\n  patch_shift_z_m: -6.5\n}\n",
     "pool.textproto:4:3: particles.patch_shift_z_m: -6.5 m",
     {"-6 to 6 m"}},
    {"EventWithoutEffect",
     "wave {}\nevents { at_s: 1 }\n",
     "pool.textproto:2:1: events[0].effect: missing",
     {"splash"}},
    {"EventTooOften",
     "wave {}\nevents {\n  every_s: 0.001\n  effect { splash {} }\n}\n",
     "pool.textproto:3:3: events[0].every_s: 0.001 s",
     {"tick"}},
    {"EventHigherThanTheBoxOfParticles",
     "particles { count: 8000 layers_count: 2 box_side_m: 4 }\nevents { effect { breaking_wave { amplitude_m: 0.3 } } "
     "}\n",
     "pool.textproto:2:35: events[0].effect.breaking_wave.amplitude_m: 0.3 m",
     {"0.9 of the water's depth"}},
    {"SplashDeeperThanTheWater",
     "wave { depth_m: 1 }\nevents { effect { splash {} } }\nevents {\n  effect {\n    splash {\n      depth_m: 0.95\n  "
     "  }\n  }\n}\n",
     "pool.textproto:6:7: events[1].effect.splash.depth_m: 0.95 m",
     {"0.9 m", "depth of 1 m"}},
    {"DefaultSplashDeeperThanTheWater",
     "wave { depth_m: 0.1 }\nevents {\n  effect { splash {} }\n}\n",
     "pool.textproto:3:12: events[0].effect.splash.depth_m: 0.8 m",
     {"0.09 m"}},
    {"SplashOutsideTheWater",
     "wave { side_m: 4 }\nevents {\n  effect { splash { x_m: 2.5 } }\n}\n",
     "pool.textproto:3:21: events[0].effect.splash.x_m: 2.5 m",
     {"outside", "-2 to 2 m"}},
    {"SplashWiderThanTheWater",
     "wave { side_m: 4 }\nevents {\n  effect { splash { radius_m: 2.5 } }\n}\n",
     "pool.textproto:3:21: events[0].effect.splash.radius_m: 2.5 m",
     {"half the side", "at most 2 m"}},
    {"SplashOutsideTheNarrowWayOfABox",
     "particles { box_side_m: 4 box_width_m: 1 }\nevents {\n  effect { splash { x_m: 1.9 z_m: 0.6 radius_m: 0.3 "
     "depth_m: 0.1 } }\n}\n",
     "pool.textproto:3:30: events[0].effect.splash.z_m: 0.6 m",
     {"outside", "-0.5 to 0.5 m"}},
    {"CrestLongerThanTheWayItRuns",
     "particles { box_side_m: 4 box_width_m: 1 }\nevents {\n  effect { breaking_wave { side: SIDE_PLUS_Z amplitude_m: "
     "0.1 length_m: 3 } }\n}\n",
     "pool.textproto:3:63: events[0].effect.breaking_wave.length_m: 3 m",
     {"at most 1 m"}},
    {"CrestHigherThanTheDepth",
     "wave { depth_m: 1 }\nevents {\n  effect { breaking_wave { amplitude_m: 1.1 } }\n}\n",
     "pool.textproto:3:28: events[0].effect.breaking_wave.amplitude_m: 1.1 m",
     {"0.9 m"}},
    {"CrestLongerThanTheWater",
     "wave { side_m: 4 }\nevents {\n  effect { breaking_wave { length_m: 5 } }\n}\n",
     "pool.textproto:3:28: events[0].effect.breaking_wave.length_m: 5 m",
     {"at most 4 m"}},
};

INSTANTIATE_TEST_SUITE_P(SceneLoader, OneErrorScene, testing::ValuesIn(kBadScenes),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(SceneLoader, ReportsEveryErrorOfAFileInOrder) {
  const std::vector<std::string> errors = errorsOf(
      "wave {\n"
      "  depth_m: 200\n"
      "  side: 3\n"
      "  damping_per_s: \"much\"\n"
      "  resolution_count: 5000\n"
      "}\n"
      "particles {\n"
      "  boundary_x: BOUNDARY_SPONGE\n"
      "  viscosity_pas: nan\n"
      "}\n");
  ASSERT_EQ(errors.size(), 6u) << testing::PrintToString(errors);
  EXPECT_THAT(errors[0], StartsWith("pool.textproto:2:3: wave.depth_m: 200 m"));
  EXPECT_THAT(errors[1], AllOf(StartsWith("pool.textproto:3:"), HasSubstr("side")));
  EXPECT_THAT(errors[2], AllOf(StartsWith("pool.textproto:4:"), HasSubstr("much")));
  EXPECT_THAT(errors[3], StartsWith("pool.textproto:5:3: wave.resolution_count: 5000"));
  EXPECT_THAT(errors[4], AllOf(StartsWith("pool.textproto:8:"), HasSubstr("BOUNDARY_SPONGE")));
  EXPECT_THAT(errors[5], StartsWith("pool.textproto:9:3: particles.viscosity_pas: nan"));
}

TEST(SceneLoader, FindsTheWordThatAnErrorIsAboutBehindTabsAndAheadOfALineBreak) {
  const std::vector<std::string> errors = errorsOf(
      "wave {\n"
      "\tboundary_plus_x: BOUNDARY_SPONGE\n"
      "\n"
      "  depth\n"
      "    : 3\n"
      "}\n"
      "allow_unstable: maybe\n");
  ASSERT_EQ(errors.size(), 3u) << testing::PrintToString(errors);
  EXPECT_THAT(errors[0], AllOf(StartsWith("pool.textproto:2:26: "), HasSubstr("BOUNDARY_SPONGE")));
  EXPECT_THAT(errors[1], AllOf(StartsWith("pool.textproto:4:3: "), HasSubstr("\"depth\"")));
  EXPECT_THAT(errors[2], AllOf(StartsWith("pool.textproto:7:17: "), HasSubstr("maybe")));
}

TEST(SceneLoader, ReportsMissingPartsBesideBadNumbers) {
  const std::vector<std::string> errors = errorsOf("particles { count: 0 }\ncoupling {}\n");
  ASSERT_EQ(errors.size(), 2u) << testing::PrintToString(errors);
  EXPECT_THAT(errors[0], StartsWith("pool.textproto:1:13: particles.count: 0 particles is below the minimum of 1"));
  EXPECT_THAT(errors[1], StartsWith("pool.textproto:2:1: coupling: needs a wave"));
}

TEST(SceneLoader, BoundsItsReport) {
  std::string text = "wave {}\n";
  for (int i = 0; i < 500; ++i) text += "nonsense: 1\n";
  const std::vector<std::string> errors = errorsOf(text);
  EXPECT_EQ(errors.size(), 101u);
  EXPECT_EQ(errors.back(), "pool.textproto: and more; correct these first");
}

TEST(SceneLoader, RefusesMoreEventsThanTheBound) {
  std::string text = "wave {}\n";
  for (int i = 0; i <= kSceneEventMaxCount; ++i) text += "events { effect { splash {} } }\n";
  const std::vector<std::string> errors = errorsOf(text);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_THAT(errors[0], StartsWith("pool.textproto:258:1: events[256]: 257 events are more than 256"));
}

TEST(SceneLoader, ReadsAMebibyteOfErrorsWithoutReadingItAgainForEach) {
  std::string text;
  while (text.size() + 5 < kSceneFileMaxBytes) text += "a: 1\n";
  EXPECT_EQ(errorsOf(text).size(), 101u);
}

TEST(SceneLoader, RefusesDeepNestingWithoutRecursing) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "a{";
  const std::vector<std::string> errors = errorsOf(text);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_THAT(errors[0], HasSubstr("nest deeper"));
}

TEST(SceneLoader, NamesASceneAfterItsFile) {
  const auto scene = parseSceneText("wave {}", "some/folder/still_pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name(), "still_pool");
  const auto named = parseSceneText("name: \"calm\" wave {}", "some/folder/still_pool.textproto");
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->name(), "calm");
}

TEST(SceneLoader, AcceptsAnEffectExactlyAtItsBounds) {
  const auto scene = parseSceneText(
      "wave { side_m: 4 depth_m: 1 }\n"
      "events { effect { splash { x_m: 2 z_m: -2 radius_m: 2 depth_m: 0.9 } } }\n"
      "events { effect { breaking_wave { amplitude_m: 0.9 length_m: 4 } } }\n",
      "pool.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
}

class SceneFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    folder_.write(name, text);
    return folder_.path() / name;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(SceneFile, LoadsWithItsNameAndDefaults) {
  const auto scene = loadSceneFile(write("tank.textproto", "wave { depth_m: 2 }\n"));
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name(), "tank");
  EXPECT_EQ(scene->wave().depth_m(), 2.0);
  EXPECT_EQ(scene->wave().side_m(), 24.0);
}

TEST_F(SceneFile, ThatIsMissingIsUnavailable) {
  const auto scene = loadSceneFile(folder_.path() / "none.textproto");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(scene.error().message, AllOf(HasSubstr("none.textproto"), HasSubstr("there is no such file")));
}

TEST_F(SceneFile, ThatIsADirectoryIsUnavailable) {
  const auto scene = loadSceneFile(folder_.path());
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(scene.error().message, HasSubstr("is a directory"));
}

TEST_F(SceneFile, ThatIsADeviceIsUnavailable) {
  const auto scene = loadSceneFile("/dev/zero");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, HasSubstr("not a regular file"));
}

TEST_F(SceneFile, ThatCannotBeReadIsUnavailable) {
  // Reading the process's own memory at address 0 fails for every user, root included.
  const auto scene = loadSceneFile("/proc/self/mem");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(scene.error().message, AllOf(HasSubstr("/proc/self/mem"), HasSubstr("cannot be read")));
}

TEST_F(SceneFile, OverOneMebibyteIsRefusedAndOneOfExactlyThatSizeIsNot) {
  std::string text = "wave {}\n#";
  text.resize(kSceneFileMaxBytes, 'x');
  const auto fits = loadSceneFile(write("fits.textproto", text));
  EXPECT_TRUE(fits) << fits.error().message;
  text += 'x';
  const auto big = loadSceneFile(write("big.textproto", text));
  ASSERT_FALSE(big);
  EXPECT_EQ(big.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_THAT(big.error().message, AllOf(HasSubstr("big.textproto"), HasSubstr("1048576 bytes")));
}

TEST_F(SceneFile, WithAFileNameThatIsNoSceneNameMustNameItsScene) {
  const auto scene = loadSceneFile(write("my pool.textproto", "wave {}\n"));
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, HasSubstr(": name: \"my pool\" is not a name"));
}

}  // namespace
}  // namespace spindrift::scene
