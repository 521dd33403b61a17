// Tokens, scripted clients, logs and their replay, through the program.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <boost/json.hpp>
#include <gmock/gmock.h>

#include "program_fixture.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class People : public ProgramTest {
 protected:
  /// The server's URL; empty without a usable device (the test is then skipped).
  std::string urlOfServer(const std::vector<std::string>& more = {}, const std::vector<std::string>& environment = {}) {
    return serve(more, environment) ? "ws://127.0.0.1:" + std::to_string(port_) : "";
  }
  std::string script(const std::string& text) const { return scene(text, "script.textproto"); }
  std::string logFile() const {
    for (const auto& entry : fs::directory_iterator(folder().path() / "logs")) return entry.path().string();
    return "";
  }
};

constexpr const char* kSplash = R"(
  steps { command { command { splash { depth_m: 0.2 radius_m: 1 } } } }
  steps { surface { x_m: 0 z_m: 0 max_m: -0.02 within_s: 30 } }
)";

TEST_F(People, ScriptEndsWith0OrWith1) {
  const std::string url = urlOfServer();
  if (url.empty()) GTEST_SKIP() << "no device";
  const Outcome good = runProgram({"script", "--url", url, script(kSplash)});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_THAT(good.out, HasSubstr("applied at tick"));
  const std::string bad_script = script("steps { command { command { splash { depth_m: 49 } } } } steps { wait {} }");
  const Outcome bad = runProgram({"script", "--url", url, bad_script});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("FAILED"));
  EXPECT_THAT(bad.out, HasSubstr("1 steps were not run"));
  const Outcome json = runProgram({"script", "--url", url, "--json", "-", bad_script});
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_FALSE(boost::json::parse(json.out).at("passed").as_bool());
  stop(SIGINT);
}

TEST_F(People, ScriptWithoutServerOrFileIsReported) {
  expectOneErrorLine(runProgram({"script", "--url", "http://x", script(kSplash)}), 2, {"--url", "ws://"});
  expectOneErrorLine(runProgram({"script", "/nonexistent"}), 2, {"/nonexistent"});
  expectOneErrorLine(runProgram({"script", script("steps { dance {} }")}), 2, {"script.textproto:1:", "dance"});
  const Outcome alone = runProgram({"script", "--url", "ws://127.0.0.1:1", script(kSplash)});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_THAT(alone.out, HasSubstr("no connection to 127.0.0.1:1"));
}

TEST_F(People, HeldScriptHasASeedAndAReport) {
  const std::string url = urlOfServer();
  if (url.empty()) GTEST_SKIP() << "no device";
  const std::string file = path("report.xml");
  const auto report = [&file] {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto held = [](const std::string& steps) { return "hold_clock: true " + steps; };
  const std::string good = scene(held("steps { at_s: 0.5 hash {} }"), "good.textproto");
  const Outcome first = runProgram({"script", "--url", url, "--seed", "7", "--junit", file, good});
  EXPECT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_THAT(first.out, HasSubstr("30 ticks, 0.500 s, seed 7: state hash 0x"));
  EXPECT_THAT(report(), HasSubstr("tests=\"1\" failures=\"0\""));
  const Outcome again = runProgram({"script", "--url", url, "--seed", "7", "--json", "-", good});
  const std::string hash(boost::json::parse(again.out).at("state_hash").as_string());
  EXPECT_THAT(first.out, HasSubstr(hash));
  const std::string bad = scene(held("steps { hash { is: 1 } }"), "bad.textproto");
  EXPECT_EQ(runProgram({"script", "--url", url, "--junit", file, bad}).exit_code, 1);
  EXPECT_THAT(report(), HasSubstr("<failure message=\"client: 0x")) << "written, too";
  expectOneErrorLine(runProgram({"script", "--url", url, "--seed", "7", script("steps { wait {} }")}), 2,
                     {"--seed", "hold_clock: true"});
  expectOneErrorLine(runProgram({"script", "--url", url, "--seed", "-1", good}), 2, {"--seed", "-1"});
  expectOneErrorLine(runProgram({"script", "--url", url, "--junit", "/nonexistent/x.xml", good}), 2,
                     {"--junit", "/nonexistent"});
  stop(SIGINT);
}

TEST_F(People, TokensAreReadAndNeverPrinted) {
  const std::string tokens = scene("operator chief-chief-chief\nplayer crew-crew-crew-1\n", "tokens");
  const std::string url = urlOfServer({"--tokens", tokens, "--guests", "none"});
  if (url.empty()) GTEST_SKIP() << "no device";
  EXPECT_EQ(runProgram({"script", "--url", url, script(kSplash)}).exit_code, 1) << "guests are turned away";
  const std::string as_crew = script(std::string("clients { name: \"a\" token_env: \"CREW\" }") + kSplash);
  EXPECT_EQ(runProgram({"script", "--url", url, as_crew}, {"CREW=crew-crew-crew-1"}).exit_code, 0);
  EXPECT_EQ(runProgram({"script", "--url", url, as_crew}, {"CREW=wrong-wrong-wrong"}).exit_code, 1);
  stop(SIGINT);
  EXPECT_THAT(child_->err(), Not(HasSubstr("crew-crew")));
  EXPECT_THAT(child_->err(), Not(HasSubstr("wrong-wrong")));

  const std::string second = urlOfServer({}, {"SPINDRIFT_TOKENS=operator chief-chief-chief; player crew-crew-crew-1"});
  EXPECT_EQ(runProgram({"script", "--url", second, as_crew}, {"CREW=crew-crew-crew-1"}).exit_code, 0);
  EXPECT_EQ(runProgram({"script", "--url", second, script(kSplash)}).exit_code, 1) << "guests are viewers now";
  stop(SIGINT);
}

TEST_F(People, GuestsArePlayersOfAReachableServer) {
  const auto statusOf = [this](const std::string& action, const std::string& token) {
    const std::string headers = "Content-Type: application/json\r\n";
    return httpRequest(port_, "POST", "/api/v1/rooms/main/commands",
                       headers + (token.empty() ? "" : "Authorization: Bearer " + token + "\r\n"), action)
        .status;
  };
  const std::string splash = R"({"splash": {}})";
  const std::string pause = R"({"setPaused": {"paused": true}})";
  if (!serve()) GTEST_SKIP() << "no device";
  EXPECT_EQ(statusOf(pause, ""), 200U) << "on the loopback without a proxy";
  stop(SIGINT);

  ASSERT_TRUE(serve({"--trust-proxy", "127.0.0.1"}));
  const auto line = child_->waitForLine("Link of the operator: ");
  ASSERT_TRUE(line);
  const std::string start = "Link of the operator: http://127.0.0.1:" + std::to_string(port_) + "/#token=";
  ASSERT_THAT(*line, testing::StartsWith(start));
  const std::string token = line->substr(start.size());
  EXPECT_EQ(statusOf(splash, ""), 200U);
  EXPECT_EQ(statusOf(pause, ""), 403U);
  child_->signal(SIGHUP);
  EXPECT_EQ(statusOf(pause, token), 200U);
  EXPECT_EQ(statusOf(pause, ""), 403U);
  stop(SIGINT);
  EXPECT_THAT(child_->err(), HasSubstr("SIGHUP: 1 tokens"));
  EXPECT_THAT(child_->err(), Not(HasSubstr(token))) << "the log has no tokens";
}

TEST_F(People, TokensThatCannotBeReadAreReported) {
  const auto refused = [&](std::vector<std::string> more, const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"serve", "--device", "software", "--port", "0", "--scene", smallScene()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = runProgram(arguments);
    if (outcome.exit_code == 3) return;
    expectOneErrorLine(outcome, 2, words);
  };
  refused({"--tokens", "/nonexistent"}, {"--tokens-file /nonexistent"});
  refused({"--tokens", scene("# nobody\n", "tokens")}, {"no token"});
  refused({"--tokens", scene("king abcdefghijklmnop\n", "tokens")}, {"tokens:1:", "not a role"});
  refused({"--guests", "none"}, {"--guests none"});
}

TEST_F(People, ALogIsReplayedBitForBit) {
  const std::string url = urlOfServer({"--record", path("logs"), "--hash-every", "10"});
  if (url.empty()) GTEST_SKIP() << "no device";
  EXPECT_EQ(runProgram({"script", "--url", url, script(kSplash)}).exit_code, 0);
  stop(SIGINT);
  const Outcome replay = runProgram({"replay", "--device", "software", logFile()});
  EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("1 commands carried out again"));
  EXPECT_THAT(replay.out, HasSubstr("bit for bit"));
  const Outcome json = runProgram({"replay", "--device", "software", "--json", "-", logFile()});
  EXPECT_TRUE(boost::json::parse(json.out).at("same").as_bool());
  expectOneErrorLine(runProgram({"replay", shippedScene("pool")}), 2, {"not a log", "spinrec1"});
  expectOneErrorLine(runProgram({"replay", "/nonexistent"}), 2, {"/nonexistent"});
}

}  // namespace
}  // namespace spindrift::test
