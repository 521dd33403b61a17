// Scripted clients against a live server: expectations that hold, and reports of those that do not.
#include <atomic>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <spindrift/script/script.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

constexpr const char* kScriptLagoon = R"(
  wave { resolution_count: 64 side_m: 24 depth_m: 2 }
  particles { count: 512 layers_count: 2 headroom_m: 2 }
  coupling {}
  boats { capacity_count: 4 }
  stream { frame_rate_hz: 60 }
)";

constexpr const char* kScriptStorm = R"(
  wave { resolution_count: 48 side_m: 12 depth_m: 1 }
  boats { capacity_count: 2 }
  storm { level_ratio: 1 drops_per_m2_s: 2 }
  stream { frame_rate_hz: 60 }
)";

class Script : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", kScriptLagoon}, {"other", kStillWave}, {"storm", kScriptStorm}};
  }
  void adjust(service::WaterServerOptions& options) const override { options.rules.grace = std::chrono::hours(1); }

  script::ScriptReport run(const std::string& text) {
    auto script = script::parseScript(text, "test");
    EXPECT_TRUE(script) << script.error().message;
    const auto there = url();
    return script ? script::runScript(*script, *there) : script::ScriptReport{};
  }
  core::Result<net::ClientUrl> url() {
    return net::ClientUrl::parse("ws://127.0.0.1:" + std::to_string(server().port()));
  }
  static std::string failures(const script::ScriptReport& report) {
    std::string out;
    for (const script::StepReport& step : report.steps) {
      if (!step.passed) out += std::to_string(step.index) + " " + step.what + ": " + step.detail + "\n";
    }
    return out;
  }
};

TEST_F(Script, SplashIsSeenByAnotherClient) {
  const auto report = run(R"(
    clients { name: "ada" }
    clients { name: "bob" subscribe { layer: LAYER_SURFACE max_rate_hz: 60 } }
    steps { client: "bob" frames { layer: LAYER_SURFACE min_count: 3 } }
    steps { client: "bob" surface { x_m: 3 z_m: -2 min_m: -0.001 max_m: 0.001 } }
    steps { client: "ada" command { command { splash { x_m: 3 z_m: -2 depth_m: 0.5 radius_m: 2 duration_s: 0.3 } } } }
    steps { client: "bob" surface { x_m: 3 z_m: -2 max_m: -0.1 within_s: 20 } }
    steps { client: "bob" particles { min_count: 512 max_count: 512 } }
    steps { client: "bob" gap { layer: LAYER_SURFACE longest_s: 20 } }
  )");
  EXPECT_TRUE(report.passed()) << failures(report);
  ASSERT_EQ(report.clients.size(), 2u);
  EXPECT_EQ(report.clients[0].answer_count, 1u);
  EXPECT_GT(report.clients[1].received_bytes, 1000u);
  EXPECT_EQ(report.clients[1].malformed_count, 0u);
}

TEST_F(Script, RepeatedFramesOfAPauseAreOneState) {
  const auto report = run(R"(
    clients { name: "ada" }
    clients { name: "bob" subscribe { layer: LAYER_SURFACE max_rate_hz: 60 } }
    steps { client: "ada" command { command { set_paused { paused: true } } } }
    steps { client: "bob" frames { layer: LAYER_SURFACE min_count: 3 within_s: 20 } }
    steps { client: "ada" command { command { reset {} } } }
    steps { client: "bob" frames { layer: LAYER_SURFACE min_count: 3 within_s: 20 } }
  )");
  EXPECT_TRUE(report.passed()) << failures(report);
  ASSERT_EQ(report.clients.size(), 2u);
  ASSERT_EQ(report.clients[1].layers.size(), 1u);
  EXPECT_GE(report.clients[1].layers[0].frame_count, 6u);
  EXPECT_EQ(report.clients[1].layers[0].state_count, 2u) << "before the reset and after it, at the same tick";
}

TEST_F(Script, PeopleResumeTheirBoats) {
  const auto report = run(R"(
    clients { name: "ada" person: "Ada" }
    clients { name: "bob" person: "Bob" }
    steps { client: "ada" command { command { spawn_boat { boat { x_m: 0 z_m: 4 } } } save_boat: "a" } }
    steps { client: "bob" people { count: 2 within_s: 20 } }
    steps { client: "bob" boat { boat: "a" x_m: 0 z_m: 4 radius_m: 2 within_s: 20 } }
    steps { client: "bob" command { boat: "a" command { control_boat { throttle_ratio: 1 } } rejected: REJECT_REASON_NOT_YOURS } }
    steps { client: "ada" command { boat: "a" command { control_boat { throttle_ratio: 1 } } } }
    steps { client: "bob" boat { boat: "a" x_m: 6 z_m: 4 radius_m: 3 within_s: 20 } }
    steps { client: "ada" disconnect { vanish: true } }
    steps { client: "bob" people { count: 1 within_s: 20 } }
    steps { client: "bob" command { boat: "a" command { control_boat { throttle_ratio: 1 } } rejected: REJECT_REASON_NOT_YOURS
                                    rejected_field: "control_boat.boat_id" } }
    steps { client: "ada" connect {} }
    steps { client: "ada" command { boat: "a" command { control_boat { throttle_ratio: -1 } } } }
    steps { client: "bob" people { count: 2 within_s: 20 } }
    steps { client: "ada" command { boat: "a" command { remove_boat {} } } }
  )");
  EXPECT_TRUE(report.passed()) << failures(report);
}

TEST_F(Script, AFailedStepIsReportedAndEndsTheScript) {
  const auto report = run(R"(
    steps { command { command { splash { depth_m: 49 } } } }
    steps { command { command { splash { depth_m: 0.2 } } } }
  )");
  EXPECT_FALSE(report.passed());
  ASSERT_EQ(report.steps.size(), 1u);
  EXPECT_THAT(report.steps[0].detail, HasSubstr("OUT_OF_RANGE splash.depth_m"));
  EXPECT_EQ(report.step_count, 2);
}

TEST_F(Script, ContinuesWithKeepGoingAndReportsEveryFailure) {
  const auto report = run(R"(
    keep_going: true
    steps { command { command { splash { depth_m: 0.2 } } rejected: REJECT_REASON_BUSY } }
    steps { surface { x_m: 0 z_m: 0 min_m: 10 within_s: 0.1 } }
    steps { surface { x_m: 100 z_m: 0 min_m: -10 within_s: 0.1 } }
    steps { boat { boat_id: 7 within_s: 0.3 } }
    steps { boat { boat: "nobodys" } }
    steps { particles { min_count: 513 within_s: 0.1 } }
    steps { frames { layer: LAYER_FOAM min_count: 1 within_s: 0.1 } }
    steps { people { count: 9 within_s: 0.1 } }
    steps { event { kind: ROOM_EVENT_KIND_RESET within_s: 0.1 } }
    steps { closed { code: 1008 within_s: 0.1 } }
    steps { gap { layer: LAYER_SURFACE longest_s: 0 } }
    steps { command { command { reset {} } } }
  )");
  ASSERT_EQ(report.steps.size(), 12u);
  for (std::size_t k = 0; k < 11; ++k) EXPECT_FALSE(report.steps[k].passed) << k << report.steps[k].detail;
  EXPECT_TRUE(report.steps[11].passed) << report.steps[11].detail;
  EXPECT_THAT(report.steps[0].detail, HasSubstr("wanted REJECT_REASON_BUSY"));
  EXPECT_THAT(report.steps[3].detail, HasSubstr("boat 7"));
}

TEST_F(Script, SeesEventsAndRefusals) {
  const auto report = run(R"(
    clients { name: "ada" }
    clients { name: "lost" room: "nowhere" }
    clients { name: "rude" room: "other" }
    steps { client: "ada" command { command { reset {} } } }
    steps { client: "ada" event { kind: ROOM_EVENT_KIND_RESET within_s: 20 } }
    steps { client: "lost" closed { within_s: 20 } }
    steps { client: "rude" subscribe { layer: LAYER_UNSPECIFIED } }
    steps { client: "rude" closed { code: 1008 within_s: 20 } }
  )");
  EXPECT_TRUE(report.passed()) << failures(report);
}

/// A script whose water depends on its seed, its commands and their times.
std::string heldScript(std::uint64_t seed, double depth_m) {
  return fmt::format(R"(
    hold_clock: true
    seed: {}
    clients {{ name: "ada" room: "storm" }}
    clients {{ name: "bob" room: "storm" }}
    steps {{ surface {{ x_m: 0 z_m: 0 min_m: -0.5 max_m: 0.5 }} }}
    steps {{ at_s: 0.25 client: "bob" command {{ command {{ splash {{ depth_m: {} radius_m: 1 }} }} }} }}
    steps {{ at_s: 0.25 command {{ command {{ spawn_boat {{ boat {{ x_m: 2 z_m: 1 }} }} }} save_boat: "a" }} }}
    steps {{ at_s: 0.5 command {{ boat: "a" command {{ control_boat {{ throttle_ratio: 1 }} }} }} }}
    steps {{ client: "bob" command {{ command {{ set_paused {{ paused: true }} }} rejected: REJECT_REASON_CLOCK_HELD }} }}
    steps {{ at_s: 1.5 boat {{ boat: "a" x_m: 3 z_m: 1 radius_m: 2 }} }}
    steps {{ wait {{ duration_s: 0.5 }} }}
    steps {{ hash {{ save: "end" }} }}
    steps {{ hash {{ same_as: "end" }} }}
  )",
                     seed, depth_m);
}

TEST_F(Script, HeldScriptGivesTheSameHashAtAnyLoad) {
  const auto calm = run(heldScript(7, 0.4));
  ASSERT_TRUE(calm.passed()) << failures(calm);
  ASSERT_TRUE(calm.held && calm.held->state_hash);
  EXPECT_EQ(calm.held->tick_count, 120u) << "two seconds of 60 ticks";
  EXPECT_NEAR(calm.held->made_s, 2.0, 1e-9);
  script::ScriptReport busy;
  {
    std::atomic<bool> over{false};
    std::vector<std::jthread> burners;
    for (int k = 0; k < 2; ++k) {
      burners.emplace_back([&over] {
        for (volatile std::uint64_t work = 0; !over;) work = work + 1;
      });
    }
    busy = run(heldScript(7, 0.4));
    over = true;
  }
  ASSERT_TRUE(busy.passed()) << failures(busy);
  EXPECT_EQ(busy.held->state_hash, calm.held->state_hash);
  const auto seeded = run(heldScript(8, 0.4));
  ASSERT_TRUE(seeded.passed()) << failures(seeded);
  EXPECT_NE(seeded.held->state_hash, calm.held->state_hash) << "another seed";
  const auto other = run(heldScript(7, 0.41));
  ASSERT_TRUE(other.passed()) << failures(other);
  EXPECT_NE(other.held->state_hash, calm.held->state_hash) << "another command";
}

TEST_F(Script, HeldScriptReportsAnotherHash) {
  const auto report = run(R"(
    hold_clock: true
    keep_going: true
    steps { at_s: 0.1 hash { is: 1 save: "a" } }
    steps { at_s: 0.2 hash { same_as: "a" } }
    steps { surface { x_m: 0 z_m: 0 min_m: 1 } }
  )");
  ASSERT_EQ(report.steps.size(), 3u);
  EXPECT_THAT(report.steps[0].detail, HasSubstr("at 0.100 s; wanted 0x0000000000000001"));
  EXPECT_FALSE(report.steps[1].passed) << "time has passed";
  EXPECT_THAT(report.steps[2].detail, HasSubstr("at 0.200 s, out of bounds"));
}

TEST_F(Script, TimeThatSomebodyElseHoldsIsReported) {
  ScriptedClient other = client("storm");
  v1::Command take;
  take.mutable_take_clock();
  ASSERT_TRUE(other.apply(take));
  const auto report = run(R"(
    clients { name: "ada" room: "storm" }
    steps { command { command { set_speed { speed: 2 } } } }
  )");
  EXPECT_THAT(report.steps.at(0).detail, HasSubstr("CLOCK_HELD"));
}

TEST_F(Script, InvalidScriptIsRefusedWithItsLocation) {
  const auto error = [](const std::string& text) {
    const auto script = script::parseScript(text, "test");
    return script ? std::string("(accepted)") : script.error().message;
  };
  EXPECT_THAT(error("steps {"), HasSubstr("test:1:"));
  EXPECT_THAT(error("steps { surfaces {} }"), HasSubstr("surfaces"));
  EXPECT_THAT(error(""), HasSubstr("no steps"));
  EXPECT_THAT(error("steps {}"), HasSubstr("steps[0]"));
  EXPECT_THAT(error("steps { client: \"x\" wait {} }"), HasSubstr("no client \"x\""));
  EXPECT_THAT(error("clients { } steps { wait {} }"), HasSubstr("needs a name"));
  EXPECT_THAT(error("steps { boat { } }"), HasSubstr("name the boat"));
  EXPECT_THAT(error("steps { surface { } }"), HasSubstr("min_m or max_m"));
  EXPECT_THAT(error("steps { command { } }"), HasSubstr("command.command"));
  EXPECT_THAT(error("steps { at_s: -1 wait {} }"), HasSubstr("at_s"));
}

TEST_F(Script, AddressesAreRead) {
  const auto parse = [](const char* url) { return net::ClientUrl::parse(url); };
  EXPECT_EQ(parse("ws://localhost:8080")->port, "8080");
  EXPECT_EQ(parse("ws://localhost")->port, "80");
  EXPECT_EQ(parse("ws://[::1]:9/ws/pond")->host, "::1");
  EXPECT_EQ(parse("ws://[::1]:9/ws/pond")->path, "/ws/pond");
  EXPECT_FALSE(parse("ws://localhost")->is_tls);
  EXPECT_TRUE(parse("wss://localhost:8080/ws")->is_tls);
  EXPECT_EQ(parse("wss://localhost")->port, "443");
  for (const char* bad : {"", "localhost:8080", "http://localhost", "https://localhost", "ws://", "wss://",
                          "ws://h:99999", "ws://h:x", "ws://[fe80::1]:8080"}) {
    EXPECT_FALSE(parse(bad)) << bad;
  }
  EXPECT_EQ(parse("ws://[fe80::1%lo]:8080")->host, "fe80::1%lo") << "a link-local address has an interface";
}

}  // namespace
}  // namespace spindrift::test
