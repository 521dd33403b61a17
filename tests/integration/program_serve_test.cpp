// `spindrift serve` as a process: start, refusals, end.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <spindrift/v1/wire.pb.h>

#include "program_fixture.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

/// Spindrift's bound for its shutdown plus a second, and extra time for a loaded machine.
constexpr std::chrono::milliseconds kStopBound{5'000};

/// A port of the loopback interface that is already in use.
class TakenPort {
 public:
  TakenPort() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size_bytes = sizeof address;
    const bool is_listening = ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                              ::listen(socket_, 1) == 0 &&
                              ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size_bytes) == 0;
    port_ = is_listening ? ntohs(address.sin_port) : 0;
  }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;
  ~TakenPort() { ::close(socket_); }
  std::string text() const { return std::to_string(port_); }

 private:
  int socket_;
  unsigned port_ = 0;
};

using Serve = ProgramTest;

/// A server that is ready; without a usable device the test is skipped.
class RunningServe : public Serve {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder().path() / "web");
    if (!serve({"--web-root", path("web"), "--room", "b=" + smallScene()})) GTEST_SKIP() << "no device";
  }

  void expectCleanEndOn(int signal) {
    ScriptedClient client(port_);
    ASSERT_TRUE(client.isOpen());
    client.hello();
    client.subscribe(v1::LAYER_SURFACE);
    ASSERT_TRUE(client.nextFrame(v1::LAYER_SURFACE));
    child_->signal(signal);
    EXPECT_TRUE(client.ws().waitClosed());
    EXPECT_EQ(client.ws().closeCode(), 1001);
    EXPECT_EQ(child_->wait(kStopBound), 0);
    EXPECT_EQ(lineCount(child_->out()), 1) << child_->out();
    EXPECT_THAT(child_->err(), HasSubstr("room main: "));
    EXPECT_THAT(child_->err(), HasSubstr("room b: "));
    EXPECT_THAT(child_->err(), HasSubstr("1 sessions"));
  }
};

TEST_F(Serve, NamesAPortInUseWithTheFlag) {
  const TakenPort taken;
  const Outcome outcome = runProgram(arguments({"--port", taken.text()}));
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  expectOneErrorLine(outcome, 2, {"port " + taken.text(), "in use", "--port"});
}

TEST_F(Serve, NamesAnInvalidAddressWithTheFlag) {
  const Outcome outcome = runProgram(arguments({"--address", "300.1.2.3"}));
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  expectOneErrorLine(outcome, 2, {"300.1.2.3", "--address"});
}

TEST_F(Serve, NamesADeviceThatDoesNotExist) {
  expectOneErrorLine(runProgram(arguments({"--device", "99"})), 3, {"device 99 does not exist", "software"});
}

TEST_F(Serve, NamesAnInvalidDevice) {
  expectOneErrorLine(runProgram(arguments({"--device", "fast"})), 2, {"\"fast\"", "auto, software"});
}

TEST_F(Serve, MissingDeviceIsReportedWithARemedy) {
  const Outcome probe = runProgram({"info"}, withoutDevices());
  if (probe.exit_code == 0) GTEST_SKIP() << "this libEGL is not libglvnd: its drivers cannot be hidden";
  expectOneErrorLine(runProgram(arguments(), withoutDevices()), 3,
                     {"no usable EGL device", "__EGL_VENDOR_LIBRARY_DIRS"});
}

TEST_F(Serve, NamesAMissingScene) {
  expectOneErrorLine(runProgram({"serve", "--scene", "/nonexistent/lake.textproto"}), 2,
                     {"'/nonexistent/lake.textproto'", "no such file"});
}

TEST_F(Serve, ReportsABadSceneWithFileLineAndColumn) {
  const std::string file = scene("wave {\n  depht_m: 1\n}\n");
  expectOneErrorLine(runProgram({"serve", "--scene", file}), 2, {file + ":2:", "depht_m"});
}

TEST_F(Serve, RoomWithoutASceneIsRefusedWithTheForm) {
  expectOneErrorLine(runProgram(arguments({"--room", "pond"})), 2, {"--room", "pond is not a room", "NAME=SCENE"});
  expectOneErrorLine(runProgram(arguments({"--room", "pond="})), 2, {"--room", "pond= is not a room", "NAME=SCENE"});
}

TEST_F(Serve, RoomWithoutANameIsRefusedWithTheForm) {
  expectOneErrorLine(runProgram(arguments({"--room", "=default"})), 2,
                     {"--room", "=default is not a room", "NAME=SCENE"});
}

TEST_F(Serve, NamesAnInvalidRoomName) {
  expectOneErrorLine(runProgram(arguments({"--room", "the pond=" + smallScene()})), 2, {"'the pond'", "letters"});
}

TEST_F(Serve, NamesARoomGivenTwice) {
  expectOneErrorLine(runProgram(arguments({"--room", "a=" + smallScene(), "--room", "a=" + smallScene()})), 2,
                     {"--room 'a=", "of this name already"});
  expectOneErrorLine(runProgram(arguments({"--room", "main=" + smallScene()})), 2, {"'main' is the one of --scene"});
}

TEST_F(RunningServe, MissingWebClientIsReportedWithARemedy) {
  const HttpAnswer answer = httpRequest(port_, "GET", "/");
  EXPECT_EQ(answer.status, 503u);
  EXPECT_THAT(answer.body, HasSubstr("not built"));
  EXPECT_THAT(answer.body, HasSubstr("./dev build"));
  EXPECT_EQ(httpRequest(port_, "GET", "/healthz").status, 200u);
}

TEST_F(RunningServe, ServesTheWebClientOnceItIsThere) {
  folder().write("web/index.html", "<!doctype html>water\n");
  const HttpAnswer answer = httpRequest(port_, "GET", "/");
  EXPECT_EQ(answer.status, 200u);
  EXPECT_EQ(answer.body, "<!doctype html>water\n");
}

/// The niceness of each thread of a process.
std::vector<int> nicenesses(pid_t process) {
  std::vector<int> out;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::ifstream file(task.path() / "stat");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    constexpr int kNicenessField = 17;  // of those after the name, see proc(5)
    std::string field;
    for (int k = 0; k < kNicenessField; ++k) fields >> field;
    if (!field.empty()) out.push_back(std::stoi(field));
  }
  return out;
}

TEST_F(RunningServe, OnlyTheBuilderHasItsLowPriority) {
  // A software rasteriser's threads inherit it from the thread that builds the first water. They compute every tick.
  constexpr int kBuilderNiceness = 10;
  const auto lowCount = [&] { return std::ranges::count(nicenesses(child_->processId()), kBuilderNiceness); };
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (lowCount() == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(lowCount(), 1);
  EXPECT_GT(nicenesses(child_->processId()).size(), 4u);
}

TEST_F(RunningServe, HasEveryRoomOfItsCommandLine) {
  EXPECT_EQ(ScriptedClient(port_, "main").greeting().room(), "main");
  EXPECT_EQ(ScriptedClient(port_, "b").greeting().room(), "b");
  EXPECT_EQ(ScriptedClient(port_).greeting().room(), "main");
}

TEST_F(RunningServe, OffersTheShippedScenes) {
  const ScriptedClient one(port_);
  EXPECT_THAT(one.greeting().scenes(), testing::IsSupersetOf({"harbor", "wave_only"}));
}

TEST_F(RunningServe, EndsCleanlyOnSigterm) {
  expectCleanEndOn(SIGTERM);
}

TEST_F(RunningServe, EndsCleanlyOnSigint) {
  expectCleanEndOn(SIGINT);
}

TEST_F(RunningServe, EndsAtOnceWithoutClients) {
  const auto begin = std::chrono::steady_clock::now();
  child_->signal(SIGTERM);
  EXPECT_EQ(child_->wait(kStopBound), 0);
  EXPECT_THAT(child_->err(), testing::Not(HasSubstr("draining")));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kStopBound);
}

TEST_F(RunningServe, TellsItsClientsBeforeItEnds) {
  ScriptedClient client(port_);
  client.hello({.minor = 2});
  ScriptedClient older(port_);
  older.hello({.minor = 1});
  ASSERT_NE(client.welcome().person_id(), 0u);
  ASSERT_NE(older.welcome().person_id(), 0u);
  child_->signal(SIGTERM);
  const auto draining = client.waitFor(v1::ServerMessage::kDraining);
  ASSERT_TRUE(draining);
  EXPECT_DOUBLE_EQ(draining->draining().closes_in_s(), 1.0);
  EXPECT_EQ(draining->draining().go_to(), "");
  EXPECT_GE(draining->draining().reconnect_after_min_s(), 1.0);
  EXPECT_GT(draining->draining().reconnect_after_max_s(), draining->draining().reconnect_after_min_s());
  EXPECT_TRUE(client.ws().waitClosed());
  EXPECT_EQ(client.ws().closeCode(), 1001);
  EXPECT_FALSE(older.waitFor(v1::ServerMessage::kDraining)) << "wire 1.1 does not have this message";
  EXPECT_EQ(older.ws().closeCode(), 1001);
  EXPECT_EQ(child_->wait(kStopBound), 0);
}

TEST_F(RunningServe, EndsInTimeDespiteASilentClient) {
  ScriptedClient deaf(port_);
  deaf.hello();
  deaf.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(deaf.nextFrame(v1::LAYER_SURFACE));
  child_->signal(SIGTERM);
  EXPECT_EQ(child_->wait(kStopBound), 0);
}

}  // namespace
}  // namespace spindrift::test
