// Faults of the machine beneath the program (docs/faults.md): no file descriptors, a clock that is set, shaders that do
// not compile at the start.
#include <ctime>
#include <filesystem>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include "program_fixture.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

std::size_t countOf(const std::string& words, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

class FaultyMachine : public ProgramTest {
 protected:
  std::vector<std::string> keeping() const {
    return arguments({"--state-dir", path("state"), "--snapshot-every-s", "1"});
  }

  /// start() with a limit of open files, hard and soft.
  bool startWithDescriptors(int count) {
    std::vector<std::string> all = {"-c", fmt::format("ulimit -n {}; exec \"$0\" \"$@\"", count), SPINDRIFT_PROGRAM};
    const auto more = keeping();
    all.insert(all.end(), more.begin(), more.end());
    return start("/bin/sh", all);
  }
  double metric(const std::string& name) const {
    const std::string body = httpRequest(port_, "GET", "/metrics").body;
    const std::size_t at = body.find("\nspindrift_" + name + " ");
    return at == std::string::npos ? -1.0 : std::stod(body.substr(at + name.size() + 12));
  }
};

TEST_F(FaultyMachine, FewDescriptorsLimitConnectionsAndKeepState) {
  if (!startWithDescriptors(128)) GTEST_SKIP() << "no device";
  ScriptedClient one(port_);
  ASSERT_TRUE(one.isOpen());
  one.hello();
  one.subscribe(v1::LAYER_SURFACE);
  const double places_count = metric("connections_max");
  EXPECT_GT(places_count, 4.0);
  EXPECT_LT(places_count, 128.0);
  {
    std::vector<RawTcp> flood(300);
    for (RawTcp& peer : flood) (void)peer.connect("127.0.0.1", port_);
    // Longer than the interval of snapshots, so that files are opened meanwhile.
    const auto end = std::chrono::steady_clock::now() + 3s;
    while (std::chrono::steady_clock::now() < end) {
      ASSERT_TRUE(one.apply(splash(0.01)));
      ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
    }
  }
  ScriptedClient other(port_);
  for (int k = 0; k < 50 && !other.isOpen(); ++k) {
    std::this_thread::sleep_for(100ms);
    other = ScriptedClient(port_);
  }
  EXPECT_TRUE(other.isOpen()) << "the flood is over";
  EXPECT_GT(metric("refused_total{reason=\"connection\"}"), 0.0);
  EXPECT_GE(metric("state_snapshots_total{room=\"main\"}"), 2.0);
  EXPECT_EQ(metric("state_failures_total{room=\"main\"}"), 0.0);
  EXPECT_EQ(metric("failed_accepts_total"), 0.0) << "connections left descriptors to the rest";
  const std::string log = stop();
  EXPECT_THAT(log, HasSubstr("connections at a time instead of 768: the limit of open files is 128"));
  EXPECT_THAT(log, HasSubstr("open ones is reached"));
  EXPECT_LE(countOf("closed without a reply", log), 3u) << log;
}

TEST_F(FaultyMachine, NoDescriptorsAreReportedAndRecoveredFrom) {
  if (!serve()) GTEST_SKIP() << "no device";
  ScriptedClient one(port_);
  one.hello();
  one.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  rlimit before{};
  ASSERT_EQ(::prlimit(child_->processId(), RLIMIT_NOFILE, nullptr, &before), 0);
  rlimit none = before;
  none.rlim_cur = 4;
  ASSERT_EQ(::prlimit(child_->processId(), RLIMIT_NOFILE, &none, nullptr), 0);
  RawTcp waiting;
  ASSERT_TRUE(waiting.connect("127.0.0.1", port_));
  ASSERT_TRUE(waiting.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
  const auto end = std::chrono::steady_clock::now() + 2s;
  while (std::chrono::steady_clock::now() < end) {
    ASSERT_TRUE(one.apply(splash(0.01)));
    ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  }
  ASSERT_EQ(::prlimit(child_->processId(), RLIMIT_NOFILE, &before, nullptr), 0);
  EXPECT_THAT(waiting.receiveAll(), HasSubstr("200 OK")) << "it was served when there were descriptors again";
  EXPECT_GE(metric("failed_accepts_total"), 1.0);
  const std::string log = stop();
  EXPECT_THAT(log, HasSubstr("could not be accepted (Too many open files); 1 are open and continue"));
  EXPECT_EQ(countOf("could not be accepted", log), 1u) << log;
}

/// The clock of the system is that of libfaketime (Debian's package libfaketime), whose offset a file holds; the
/// monotonic clock stays the machine's.
class SetClock : public FaultyMachine {
 protected:
  static constexpr const char* kLibrary = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

  void SetUp() override {
    if (kIsSanitized) GTEST_SKIP() << "a sanitizer must be the first library of a program, and so must libfaketime";
    if (!std::filesystem::exists(kLibrary)) GTEST_SKIP() << kLibrary << " is missing (Debian: libfaketime)";
    setOffset("+0");
  }
  void setOffset(const std::string& offset) const { folder().write("offset", offset + "\n"); }
  std::vector<std::string> environment() const {
    return {std::string("LD_PRELOAD=") + kLibrary, "FAKETIME_TIMESTAMP_FILE=" + path("offset"), "FAKETIME_NO_CACHE=1",
            "DONT_FAKE_MONOTONIC=1", "FAKETIME_DONT_FAKE_MONOTONIC=1"};
  }
  /// Whether a new client with the token is welcome.
  bool isWelcome(const std::string& token) const {
    ScriptedClient one(port_);
    one.hello({.token = token});
    return one.welcome().person_id() != 0;
  }
};

TEST_F(SetClock, MovesTokensOnly) {
  const auto expiry = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() + 1h);
  folder().write("tokens", fmt::format("operator operator-token-123\nplayer player-token-12345 until={:%FT%TZ}\n",
                                       fmt::gmtime(expiry)));
  auto all = keeping();
  all.insert(all.end(), {"--tokens-file", path("tokens")});
  if (!start(SPINDRIFT_PROGRAM, all, environment())) GTEST_SKIP() << "no device";
  ScriptedClient one(port_);
  one.hello({.token = "operator-token-123"});
  one.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.apply(splash(0.1)));
  EXPECT_TRUE(isWelcome("player-token-12345"));

  for (const auto& [offset, is_valid] : {std::pair("+2h", false), std::pair("-10h", true)}) {
    SCOPED_TRACE(offset);
    const double snapshots_count = metric("state_snapshots_total{room=\"main\"}");
    setOffset(offset);
    const auto begin = std::chrono::steady_clock::now();
    const auto first = one.apply(splash(0.01));
    ASSERT_TRUE(first);
    ASSERT_TRUE(one.runFor(180));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    EXPECT_GE(elapsed.count(), 2.5) << "three seconds of simulated time: the water must not jump with the clock";
    EXPECT_GT(metric("state_snapshots_total{room=\"main\"}"), snapshots_count) << "snapshots continue";
    EXPECT_EQ(isWelcome("player-token-12345"), is_valid);
  }
  EXPECT_EQ(metric("clock_steps_total"), 2.0);
  const auto last = one.apply(splash(0.01));
  ASSERT_TRUE(last);
  const std::string log = stop();
  EXPECT_THAT(log, AllOf(HasSubstr("the system's clock was set forward by 7200 s, or the machine slept"),
                         HasSubstr("the system's clock was set back by 43200 s: water")));

  // A start while the clock is behind the state on disk continues from the newest snapshot all the same.
  setOffset("-20h");
  ASSERT_TRUE(start(SPINDRIFT_PROGRAM, all, environment()));
  ScriptedClient again(port_);
  again.hello({.token = "operator-token-123"});
  const auto tick = again.apply(splash(0.01));
  ASSERT_TRUE(tick);
  EXPECT_GT(*tick, *last);
  EXPECT_THAT(stop(), HasSubstr("room main: continues at tick"));
}

TEST_F(FaultyMachine, BrokenShaderEndsTheStartWithFileAndLine) {
  std::filesystem::copy(SPINDRIFT_SOURCE_DIR "/shaders", folder().path() / "shaders",
                        std::filesystem::copy_options::recursive);
  folder().write("shaders/wave/continuity.comp", "layout(local_size_x = 8) in;\nvoid main() { not_glsl(); }\n");
  const Outcome outcome = runProgram(arguments({"--shader-dir", path("shaders")}));
  if (outcome.exit_code == 3) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "it was never ready";
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("room main: "), HasSubstr("wave/continuity.comp does not compile on llvmpipe"),
                    HasSubstr("Mesa"), HasSubstr("not_glsl"), HasSubstr("continuity.comp:2")));
}

}  // namespace
}  // namespace spindrift::test
