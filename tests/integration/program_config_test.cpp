// Flags, environment and configuration file of `spindrift serve` as a process, and its log as JSON.
#include <filesystem>
#include <sstream>

#include <boost/json/parse.hpp>

#include "program_fixture.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Config : public ProgramTest {
 protected:
  std::string config(const std::string& text) const { return scene(text, "serve.textproto"); }
};

/// Returns the lines of a log, each parsed as one JSON object.
std::vector<boost::json::object> jsonLines(const std::string& log) {
  std::vector<boost::json::object> objects;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    boost::system::error_code error;
    const boost::json::value value = boost::json::parse(line, error);
    EXPECT_TRUE(!error && value.is_object()) << line;
    if (value.is_object()) objects.push_back(value.as_object());
  }
  return objects;
}

TEST_F(Config, FlagReplacesVariableReplacesFile) {
  const std::string small = smallScene();
  std::filesystem::create_directories(folder().path() / "web");
  const std::string file = config(
      "scene: \"/nonexistent/lake.textproto\"\naddress: \"300.1.2.3\"\nport: 1\n"
      "guests: \"operator\"\nroom: \"pond=" +
      small +
      "\"\nlog_format: \"json\"\n"
      "device: \"software\"\nweb_root: \"" +
      (folder().path() / "web").string() + "\"\n");
  if (!start(SPINDRIFT_PROGRAM, {"serve", "--config", file, "--port", "0", "--scene", small},
             {"SPINDRIFT_ADDRESS=127.0.0.1", "SPINDRIFT_PORT=2", "SPINDRIFT_GUESTS=viewer"}))
    GTEST_SKIP() << "no device";
  EXPECT_GT(port_, 2);
  {
    ScriptedClient client(port_, "pond");
    client.hello();
    EXPECT_EQ(client.greeting().room(), "pond") << "from the file";
    EXPECT_EQ(client.welcome().role(), v1::ROLE_VIEWER) << "from the environment";
  }
  stop();
  EXPECT_EQ(lineCount(child_->out()), 1) << "the line stays as it is: " << child_->out();
  const auto log = jsonLines(child_->err());
  ASSERT_FALSE(log.empty());
  EXPECT_THAT(child_->err(), HasSubstr("terminated: closing"));
  for (const auto& line : log) {
    for (const char* key : {"time", "level", "thread", "message"}) EXPECT_TRUE(line.contains(key)) << key;
  }
}

TEST_F(Config, PrintedConfigurationIsAConfigurationFile) {
  const std::vector<std::string> environment = {"SPINDRIFT_THREADS=2", "SPINDRIFT_TOKENS=operator chief-chief-chief"};
  const Outcome first =
      runProgram({"serve", "--config", config("max_rooms: 3"), "--print-config", "--port", "0"}, environment);
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.err, "");
  for (const char* line : {"port: 0  # flag", "threads: 2  # environment: SPINDRIFT_THREADS", "max_rooms: 3  # file"})
    EXPECT_THAT(first.out, HasSubstr(line));
  EXPECT_THAT(first.out, Not(HasSubstr("chief")));
  const Outcome second = runProgram({"serve", "--print-config", "--config", config(first.out)});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  for (const char* line :
       {"port: 0  # file", "threads: 2  # file", "max_rooms: 3  # file", "scene: \"harbor\"  # file"})
    EXPECT_THAT(second.out, HasSubstr(line));
}

TEST_F(Config, AnOutputThatIsFullIsReported) {
  const Outcome outcome = runProgram({"-c", "'" SPINDRIFT_PROGRAM "' serve --print-config > /dev/full"}, {}, "/bin/sh");
  expectOneErrorLine(outcome, 2, {"--print-config", "standard output cannot be written"});
}

TEST_F(Config, InvalidFileOrVariableEndsWithOneLine) {
  const std::string file = config("\nport: 65536\n");
  expectOneErrorLine(runProgram({"serve", "--config", file}), 2, {file + ":2:1: port:", "65536", "65535"});
  expectOneErrorLine(runProgram({"serve", "--config", "/nonexistent"}), 2, {"--config /nonexistent", "check the path"});
  expectOneErrorLine(runProgram({"serve"}, {"SPINDRIFT_PORT=http"}), 2, {"SPINDRIFT_PORT", "http", "65535"});
  expectOneErrorLine(runProgram({"info"}, {"SPINDRIFT_LOG_LEVEL=loud"}), 2, {"SPINDRIFT_LOG_LEVEL", "loud", "debug"});
}

TEST_F(Config, VariablesOfServeDoNotConcernOtherCommands) {
  const Outcome outcome = runProgram({"check", smallScene()}, {"SPINDRIFT_PORT=http", "SPINDRIFT_CONFIG=/nonexistent"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Config, AFailureHasTheFormOfTheLog) {
  const Outcome outcome =
      runProgram({"serve", "--log-format", "json", "--log-level", "off", "--scene", "/nonexistent/\"a\"\n\xFF"});
  EXPECT_EQ(outcome.exit_code, 2);
  const auto log = jsonLines(outcome.err);
  ASSERT_EQ(log.size(), 1u) << outcome.err;
  EXPECT_EQ(log[0].at("level"), "error");
  EXPECT_THAT(std::string(log[0].at("message").as_string()), HasSubstr("/nonexistent/\"a\"\n\xEF\xBF\xBD"));
}

}  // namespace
}  // namespace spindrift::test
