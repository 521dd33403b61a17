// Wave-makers in scene files: what loads, and what is refused with which words.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>

#include "scene_error.h"
#include "temporary_folder.h"

namespace spindrift::scene {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kFlume = "wave { boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_REFLECT } ";

TEST(WaveMakers, ReachCoreWithTheirWavesAndDefaults) {
  const auto scene = parseSceneText(
      kFlume +
          "wave_makers { side: SIDE_MINUS_X begin_s: 2 duration_s: 30 irregular { significant_height_m: 0.2 seed: 7 } "
          "} wave_makers { solitary { height_m: 0.3 } }",
      "flume.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const std::vector<core::WaveMaker> expected = {
      {.side = core::Side::kMinusX,
       .begin_s = 2,
       .duration_s = 30,
       .waves = core::IrregularWaves{.significant_height_m = 0.2,
                                     .peak_period_s = 3,
                                     .peak_enhancement_ratio = 3.3,
                                     .waves_count = 128,
                                     .seed = 7}},
      {.side = core::Side::kPlusX, .waves = core::SolitaryWave{.height_m = 0.3}}};
  EXPECT_EQ(toCore(*scene).wave_makers, expected);
  const auto regular = parseSceneText(kFlume + "wave_makers { regular {} }", "flume.textproto");
  ASSERT_TRUE(regular) << regular.error().message;
  EXPECT_EQ(toCore(*regular).wave_makers[0].waves,
            (decltype(core::WaveMaker::waves){core::RegularWaves{.height_m = 0.1, .period_s = 3}}));
}

TEST(WaveMakers, AreRefusedWithPlaceValueAndRemedy) {
  EXPECT_THAT(errorOf("particles {} wave_makers { regular {} }"), HasSubstr("wave_makers[0]: needs a wave"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers {}"), HasSubstr("wave_makers[0]: has no waves; say which"));
  EXPECT_THAT(errorOf("wave {} wave_makers { regular {} }"),
              HasSubstr("wave_makers[0].side: SIDE_PLUS_X is WAVE_BOUNDARY_PERIODIC; a wave-maker needs a wall"));
  EXPECT_THAT(errorOf("wave { boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_ABSORB } "
                      "wave_makers { side: SIDE_PLUS_X regular {} }"),
              HasSubstr("SIDE_PLUS_X is WAVE_BOUNDARY_ABSORB"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { side: SIDE_DIRECTION regular {} }"),
              HasSubstr("wave_makers[0].side: SIDE_DIRECTION is for effects"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { regular {} } wave_makers { solitary {} }"),
              HasSubstr("wave_makers[1].side: SIDE_PLUS_X has wave_makers[0] already; one per side"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { solitary { height_m: 1.2 } }"),
              HasSubstr("wave_makers[0].solitary.height_m: 1.2 m is more than 0.78 of the water's depth of 1.5 m"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { irregular { significant_height_m: 0.7 } }"),
              HasSubstr("wave_makers[0].irregular.significant_height_m: 0.7 m is more than 0.4"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { regular { height_m: nan } }"),
              HasSubstr("wave_makers[0].regular.height_m: nan is not a finite number"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { regular { period_s: 0 } }"),
              HasSubstr("wave_makers[0].regular.period_s: 0 s is below the minimum"));
  EXPECT_THAT(errorOf(kFlume + "wave_makers { duration_s: 5 solitary {} }"),
              HasSubstr("wave_makers[0].duration_s: 5 s is for regular and irregular waves"));
  std::string many = kFlume;
  for (int k = 0; k < 5; ++k) many += " wave_makers { regular {} }";
  EXPECT_THAT(errorOf(many), HasSubstr("wave_makers[4]: 5 wave-makers are more than 4"));
}

TEST(WaveMakers, NeedARestartToChangeAndAShallowerWaterKeepsTheirRules) {
  auto scene = parseSceneText(kFlume + "wave_makers { solitary { height_m: 1 } }", "flume.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const auto error = setParameter(*scene, "wave.depth_m", 1.0);
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, HasSubstr("wave_makers[0].solitary.height_m: 1 m is more than 0.78"));
}

TEST(Series, InTheSceneAreCheckedRowByRow) {
  const auto scene = parseSceneText(
      kFlume + "wave_makers { series { time_s: [0, 1, 2.5] elevation_m: [0, 0.1, -0.05] } }", "flume.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::Scene in = toCore(*scene);
  const auto& series = std::get<core::ElevationSeries>(in.wave_makers[0].waves);
  EXPECT_THAT(series.time_s, ElementsAre(0, 1, 2.5));
  EXPECT_THAT(series.elevation_m, ElementsAre(0, 0.1, -0.05));
  const v1::Scene sent = forClients(*scene);
  EXPECT_TRUE(sent.wave_makers(0).has_series());
  EXPECT_EQ(sent.wave_makers(0).series().time_s_size(), 0) << "clients do not need the numbers";

  const auto of = [](const std::string& series_text) {
    return errorOf(kFlume + "wave_makers { series { " + series_text + " } }");
  };
  EXPECT_THAT(of(""), HasSubstr("wave_makers[0].series.time_s: 0 rows; choose 2 to 16384"));
  EXPECT_THAT(of("time_s: [0, 1] elevation_m: [0]"), HasSubstr("series.elevation_m: 1 elevations at 2 times"));
  EXPECT_THAT(of("time_s: [0, 1, 1] elevation_m: [0, 0, 0]"), HasSubstr("series.time_s[2]: 1 s is not after"));
  EXPECT_THAT(of("time_s: [0, nan] elevation_m: [0, 0]"), HasSubstr("series.time_s[1]: nan s is not a time"));
  EXPECT_THAT(of("time_s: [-1, 1] elevation_m: [0, 0]"), HasSubstr("series.time_s[0]: -1 s is not a time"));
  EXPECT_THAT(of("time_s: [0, 1] elevation_m: [0, inf]"), HasSubstr("series.elevation_m[1]: inf m is beyond 0.78"));
  EXPECT_THAT(of("time_s: [0, 1] elevation_m: [0, 0] file: \"a.txt\""), HasSubstr("series.file: and time_s are both"));
  EXPECT_THAT(of("file: \"a.txt\""),
              HasSubstr("series.file: \"a.txt\" cannot be read, because this scene is not a file"));
}

class SeriesFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_ / "scenes"); }

  /// Loads a scene file in the folder "scenes" whose series names this file.
  [[nodiscard]] core::Result<v1::Scene> load(const std::string& name) const {
    const auto file = folder_ / "scenes" / "flume.textproto";
    std::ofstream(file) << kFlume + "\nwave_makers { series { file: \"" + name + "\" } }\n";
    return loadSceneFile(file);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

TEST_F(SeriesFile, GivesARowPerTime) {
  write("scenes/wave.txt", "# time  elevation\n0 0\n\n 0.5,\t+0.1\r\n1.5e0;-2e-2  # trough");
  const auto scene = load("wave.txt");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::Scene in = toCore(*scene);
  const auto& series = std::get<core::ElevationSeries>(in.wave_makers[0].waves);
  EXPECT_THAT(series.time_s, ElementsAre(0, 0.5, 1.5));
  EXPECT_THAT(series.elevation_m, ElementsAre(0, 0.1, -0.02));
}

TEST_F(SeriesFile, ThatIsMissingDamagedOrTooLongIsNamedWithTheReason) {
  EXPECT_THAT(errorOf(load("none.txt")),
              AllOf(HasSubstr("flume.textproto:2:"),
                    HasSubstr("wave_makers[0].series.file: \"none.txt\" there is no such file")));
  EXPECT_THAT(errorOf(load(".")), HasSubstr("is a directory; name a text file in it"));
  write("scenes/words.txt", "0 0\n1 high\n");
  EXPECT_THAT(errorOf(load("words.txt")), HasSubstr("line 2: \"1 high\" is not a row"));
  write("scenes/three.txt", "0 0 0\n");
  EXPECT_THAT(errorOf(load("three.txt")), HasSubstr("line 1: \"0 0 0\" is not a row"));
  write("scenes/nan.txt", "0 0\n1 nan\n");
  EXPECT_THAT(errorOf(load("nan.txt")), HasSubstr("line 2:"));
  write("scenes/empty.txt", "# nothing\n");
  EXPECT_THAT(errorOf(load("empty.txt")), HasSubstr("has no rows"));
  write("scenes/back.txt", "0 0\n2 0\n1 0\n");
  EXPECT_THAT(errorOf(load("back.txt")), HasSubstr("series.time_s[2]: 1 s is not after the time before, 2 s"));
  std::string rows;
  for (int k = 0; k < 16385; ++k) rows += std::to_string(k) + " 0\n";
  write("scenes/long.txt", rows);
  EXPECT_THAT(errorOf(load("long.txt")), HasSubstr("has more than 16384 rows"));
  write("scenes/huge.txt", std::string(1024 * 1024 + 1, '#'));
  EXPECT_THAT(errorOf(load("huge.txt")), HasSubstr("is bigger than 1048576 bytes"));
}

TEST_F(SeriesFile, OfAnotherEncodingLoadsOrIsNamed) {
  write("scenes/mark.txt",
        "\xEF\xBB\xBF"
        "0 0\n1 0.1\n");
  EXPECT_EQ(errorOf(load("mark.txt")), "(the scene loaded)");
  write("scenes/wide.txt", std::string("\xFF\xFE"
                                       "0\0 \0"
                                       "0\0\n\0",
                                       10));
  EXPECT_THAT(errorOf(load("wide.txt")), HasSubstr("\"wide.txt\" is UTF-16 text; save it as UTF-8"));
  write("scenes/twice.txt",
        "0 0\n\xEF\xBB\xBF"
        "1 0.1\n");
  EXPECT_THAT(errorOf(load("twice.txt")), HasSubstr("line 2: \"\\u{FEFF}1 0.1\" is not a row"));
  write("scenes/space.txt",
        "0 0\n1\xC2\xA0"
        "0.1\n");
  EXPECT_THAT(errorOf(load("space.txt")), HasSubstr("line 2: \"1\\u{A0}0.1\" is not a row"));
}

TEST_F(SeriesFile, ThatIsRefusedGivesOneError) {
  for (const char* const text : {"0 0\n1 inf\n", "0 0\n2 0\n1 0\n3 high\n", "0 0\nhigh\n"}) {
    write("scenes/wrong.txt", text);
    const std::string error = errorOf(load("wrong.txt"));
    EXPECT_EQ(std::ranges::count(error, '\n'), 0) << error;
    EXPECT_THAT(error,
                HasSubstr("is not a row; give a time in seconds and an elevation in metres, both finite numbers"));
  }
}

TEST_F(SeriesFile, WhoseNameHasAZeroByteIsRefusedAndNotCut) {
  write("scenes/wave.txt", "0 0\n1 0.1\n");
  EXPECT_THAT(errorOf(load("wave.txt\\000")), HasSubstr("\"wave.txt\\u{00}\" has a zero byte in its name"));
}

TEST_F(SeriesFile, MayNotLeaveTheFolderOfTheScene) {
  write("outside.txt", "0 0\n1 0\n");
  EXPECT_THAT(errorOf(load("../outside.txt")), HasSubstr("goes up by"));
  EXPECT_THAT(errorOf(load((folder_ / "outside.txt").string())), HasSubstr("is an absolute path"));
  std::filesystem::create_symlink(folder_ / "outside.txt", folder_ / "scenes" / "link.txt");
  EXPECT_THAT(errorOf(load("link.txt")), HasSubstr("is a link that leads out of it"));
}

}  // namespace
}  // namespace spindrift::scene
