// Output and exit codes of the program when it does not serve: usage, `check`, `info`.
#include <filesystem>

#include <boost/json/parse.hpp>

#include "program_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Usage : public ProgramTest {};
class Check : public ProgramTest {};
class Info : public ProgramTest {};
class Bundle : public ProgramTest {};

TEST_F(Usage, MissingCommandIsRefused) {
  expectOneErrorLine(runProgram({}), 2, {"subcommand is required", "spindrift --help"});
}

TEST_F(Usage, NamesAnUnknownCommand) {
  expectOneErrorLine(runProgram({"swim"}), 2, {"'swim'", "spindrift --help"});
}

TEST_F(Usage, NamesAnUnknownFlag) {
  expectOneErrorLine(runProgram({"--swim"}), 2, {"'--swim'", "spindrift --help"});
}

TEST_F(Usage, NamesAnUnknownFlagOfACommand) {
  expectOneErrorLine(runProgram({"serve", "--swim"}), 2, {"--swim", "spindrift --help"});
}

TEST_F(Usage, UnknownCaseOfAStudyIsRefusedWithTheCases) {
  const Outcome outcome = runProgram({"--device", "software", "--case", "tides"}, {}, SPINDRIFT_STUDY);
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("'tides'"));
  EXPECT_THAT(outcome.err, HasSubstr("dam-break"));
}

TEST_F(Usage, QuickTradeStudyKeepsNumbersOfTheLevels) {
  const std::filesystem::path charts = folder().path() / "charts";
  const Outcome outcome = runProgram({"--device", "software", "--suite", "trade", "--quick", "--case", "splash",
                                      "--plot", charts.string(), "--json", "-"},
                                     {}, SPINDRIFT_STUDY, std::chrono::minutes(5));
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = boost::json::parse(outcome.out).as_object();
  const auto& rows = json.at("scenes").at(0).at("rows").as_array();
  ASSERT_EQ(rows.size(), 3u) << "draft, balanced, fine";
  for (const auto& row : rows) {
    EXPECT_GT(row.at("cost_ms_per_s").to_number<double>(), 0.0);
    EXPECT_GT(row.at("stream_mbit_per_s").to_number<double>(), 0.0);
    EXPECT_GT(row.at("height_rms_ratio").to_number<double>(), 0.0);
    EXPECT_LT(row.at("height_rms_ratio").to_number<double>(), 0.5);
  }
  EXPECT_LT(rows[2].at("height_rms_ratio").to_number<double>(), rows[0].at("height_rms_ratio").to_number<double>());
  const std::vector<std::string> listing = {SPINDRIFT_SOURCE_DIR "/tests/study/draw_charts.py", "--list",
                                            charts.string()};
  const Outcome listed = runProgram(listing, {}, "/usr/bin/python3");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_EQ(listed.out, "trade_splash.svg\n") << "the charts of charts/trade.json";
}

TEST_F(Usage, PortOutOfRangeIsRefusedWithTheRange) {
  expectOneErrorLine(runProgram({"serve", "--port", "65536"}), 2, {"--port", "65536", "65535"});
}

TEST_F(Usage, PortThatIsNotANumberIsRefused) {
  expectOneErrorLine(runProgram({"serve", "--port", "http"}), 2, {"--port", "http"});
}

TEST_F(Usage, UnknownLogLevelIsRefusedWithTheLevels) {
  expectOneErrorLine(runProgram({"--log-level", "loud", "info"}), 2, {"--log-level", "loud", "debug"});
}

TEST_F(Usage, UnknownSceneOfAStudyIsRefusedWithTheScenes) {
  const Outcome outcome =
      runProgram({"--device", "software", "--suite", "trade", "--quick", "--case", "lagoon"}, {}, SPINDRIFT_STUDY);
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("'lagoon'"), HasSubstr("harbor"), HasSubstr("known")));
}

class Help : public testing::TestWithParam<std::string> {};

TEST_P(Help, GoesToStandardOutputAndExitsWith0) {
  std::vector<std::string> arguments = {"--help"};
  if (!GetParam().empty()) arguments.insert(arguments.begin(), GetParam());
  const Outcome outcome = runProgram(arguments);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("Usage: spindrift"));
  EXPECT_EQ(outcome.err, "");
}

INSTANTIATE_TEST_SUITE_P(Of, Help, testing::Values("", "serve", "info", "check"),
                         [](const auto& one) { return one.param.empty() ? std::string("program") : one.param; });

TEST_F(Usage, LaboratoryHasHelpAndNamesAnUnknownFlag) {
  for (const std::string program : {SPINDRIFT_BENCH, SPINDRIFT_STUDY}) {
    const std::string name = std::filesystem::path(program).filename();
    const Outcome help = runProgram({"--help"}, {}, program);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: " + name));
    const Outcome wrong = runProgram({"--swim"}, {}, program);
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, testing::AllOf(StartsWith(name + ": "), HasSubstr("--swim"), HasSubstr(name + " --help")));
    const Outcome late = runProgram({"--device", "999"}, {}, program);
    EXPECT_THAT(late.err, StartsWith(name + ": ")) << "also of what is found after the flags were parsed";
  }
}

TEST_F(Usage, VersionIsOneLine) {
  const Outcome outcome = runProgram({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "spindrift " SPINDRIFT_VERSION "\n");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Check, MissingSceneIsRefused) {
  expectOneErrorLine(runProgram({"check"}), 2, {"scene", "required"});
}

TEST_F(Check, NamesAMissingScene) {
  expectOneErrorLine(runProgram({"check", "/nonexistent/lake.textproto"}), 2,
                     {"'/nonexistent/lake.textproto'", "no such file", "give the path"});
}

TEST_F(Check, RefusesADirectory) {
  expectOneErrorLine(runProgram({"check", folder().path().string()}), 2, {folder().path().string(), "is a directory"});
}

TEST_F(Check, ReportsAnUnknownFieldWithItsLine) {
  const std::string file = scene("wave {\n  depht_m: 1\n}\n");
  expectOneErrorLine(runProgram({"check", file}), 2, {file + ":2:", "depht_m"});
}

TEST_F(Check, ReportsAValueOutOfRangeWithItsBound) {
  const std::string file = scene("wave {\n  depth_m: 1000\n}\n");
  expectOneErrorLine(runProgram({"check", file}), 2, {file + ":2:3: wave.depth_m: 1000 m", "maximum of 100 m"});
}

TEST_F(Check, ReportsAnUnstableStepWithItsRule) {
  const std::string file = scene(
      "fixed_substeps_count: 1\nwave { resolution_count: 32 side_m: 8 depth_m: 1 }\n"
      "particles { count: 512 layers_count: 2 sound_speed_mps: 400 }\n");
  expectOneErrorLine(runProgram({"check", file}), 2,
                     {file, "fixed_substeps_count: 1", "above the bound of", "particle CFL", "use at least"});
}

TEST_F(Check, ContinuesAfterABadSceneAndExitsWith2) {
  const Outcome outcome = runProgram({"check", "/nonexistent/lake.textproto", smallScene()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.out, HasSubstr("small.textproto: valid"));
}

TEST_F(Check, PrintsTheDerivedQuantitiesOfASmallScene) {
  const Outcome outcome = runProgram({"check", smallScene()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* word : {"small.textproto: valid", "Courant number", "substeps", "memory"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST_F(Check, PrintsSidesSolverBoatsAndObstacles) {
  const std::string file = scene(
      "wave { resolution_count: 32 side_m: 16 depth_m: 1 steepening_ratio: 0.5\n"
      "  boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_REFLECT sponge_width_m: 3 }\n"
      "particles { count: 512 layers_count: 2 equation_of_state: EQUATION_OF_STATE_TAIT cohesion: true }\n"
      "obstacles { rock { x_m: 5 } }\nbeaches { width_m: 4 shore_depth_m: 0.25 }\n"
      "boats { boats { x_m: -4 height_m: 0.5 density_ratio: 0.5 } }\nstorm { level_ratio: 0.75 }\n"
      "wave_makers { begin_s: 2 solitary { height_m: 0.1 } }\n");
  const Outcome outcome = runProgram({"check", file});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* word :
       {"sides      -x absorbs, +x reflects, -z periodic, +z periodic, matched layer of 3 m", "open side  -x",
        "steepening 0.5", "weakly compressible, Tait's equation of state, conserving pressure force, cohesion",
        "obstacles  1", "beach      at +x, 4 m wide, up to a depth of 0.25 m",
        "maker      at +x: solitary wave of 0.1 m, from 2 s on", "boats      1 of at most 8", "draught 0.25 m",
        "storm      0.75"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST_F(Check, PrintsThePositionBasedSolver) {
  const Outcome outcome = runProgram({"check", scene("particles { solver: PRESSURE_SOLVER_POSITION_BASED }\n")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("position-based, 4 iterations per substep"));
}

TEST_F(Check, EveryShippedSceneIsFineAtEveryFidelity) {
  for (const char* level : {"draft", "balanced", "fine", "reference"}) {
    std::vector<std::string> arguments = {"check", "--fidelity", level};
    for (const auto& entry : std::filesystem::directory_iterator(SPINDRIFT_SOURCE_DIR "/server/scenes")) {
      if (entry.path().extension() == ".textproto") arguments.push_back(entry.path());
    }
    ASSERT_GT(arguments.size(), 10u);
    const Outcome outcome = runProgram(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << level << ": " << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(std::string("), ") + level));
  }
  expectOneErrorLine(runProgram({"check", "--fidelity", "best", smallScene()}), 2, {"--fidelity", "best"});
}

TEST_F(Check, ReportsARuleBetweenFieldsWithARemedy) {
  const std::string file = scene("wave {}\nboats {\n  boats { x_m: 50 }\n}\n");
  expectOneErrorLine(runProgram({"check", file}), 2,
                     {file + ":3:11: boats.boats[0].x_m: 50 m", "choose -10.8 to 10.8 m"});
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, IsFine) {
  const Outcome outcome = runProgram({"check", shippedScene(GetParam())});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(": valid"));
}

std::vector<std::string> shippedNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SPINDRIFT_SOURCE_DIR "/server/scenes")) {
    if (entry.path().extension() == ".textproto") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Of, ShippedScene, testing::ValuesIn(shippedNames()),
                         [](const auto& one) { return one.param; });

TEST_F(Info, JsonIsTheOnlyTextOnStandardOutput) {
  const Outcome outcome = runProgram({"info", "--json", "-"});
  if (outcome.exit_code == 3) GTEST_SKIP() << "no usable device";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  boost::system::error_code error;
  const boost::json::value json = boost::json::parse(outcome.out, error);
  ASSERT_FALSE(error) << outcome.out;
  EXPECT_THAT(std::string(json.at("program").as_string()), StartsWith("spindrift "));
  EXPECT_TRUE(json.at("chosen").is_object());
  EXPECT_FALSE(json.at("devices").as_array().empty());
}

TEST_F(Info, JsonGoesToAFileBesideTheText) {
  const std::string file = (folder().path() / "info.json").string();
  const Outcome outcome = runProgram({"info", "--json", file});
  if (outcome.exit_code == 3) GTEST_SKIP() << "no usable device";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("program   spindrift"));
  EXPECT_GT(std::filesystem::file_size(file), 100u);
}

TEST_F(Info, NamesAJsonFileThatCannotBeWritten) {
  const Outcome outcome = runProgram({"info", "--json", "/nonexistent/info.json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("--json: Value '/nonexistent/info.json' cannot be written: there is no folder /nonexistent"));
}

TEST_F(Info, MissingDeviceIsPrintedWithExitCode3) {
  const Outcome outcome = runProgram({"info", "--json", "-"}, withoutDevices());
  if (outcome.exit_code == 0) GTEST_SKIP() << "this libEGL is not libglvnd: its drivers cannot be hidden";
  EXPECT_EQ(outcome.exit_code, 3);
  boost::system::error_code error;
  const boost::json::value json = boost::json::parse(outcome.out, error);
  ASSERT_FALSE(error) << outcome.out;
  EXPECT_TRUE(json.at("chosen").is_null());
  EXPECT_THAT(std::string(json.at("why").as_string()), HasSubstr("__EGL_VENDOR_LIBRARY_DIRS"));
}

TEST_F(Info, ParameterReferenceIsATable) {
  const Outcome outcome = runProgram({"info", "--parameters"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, StartsWith("| Parameter |"));
  EXPECT_THAT(outcome.out, HasSubstr("particles.viscosity_pas"));
}

TEST_F(Bundle, FindsItsScenesBesideItself) {
  // The layout of ./dev bundle: the program two folders deep, its data in share/.
  const auto program = folder().path() / "bin" / "spindrift";
  std::filesystem::create_directories(program.parent_path());
  std::filesystem::copy_file(SPINDRIFT_PROGRAM, program);
  folder().write("share/spindrift/scenes/tiny.textproto", "wave { resolution_count: 32 }\n");
  const Outcome found = runProgram({"check", "tiny"}, {}, program.string());
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("tiny.textproto: valid"));
  expectOneErrorLine(runProgram({"check", "huge"}, {}, program.string()), 2,
                     {"scene 'huge'", "neither a file nor a shipped scene", "shipped are: tiny"});
}

}  // namespace
}  // namespace spindrift::test
