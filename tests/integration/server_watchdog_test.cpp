// The watchdog over a real connection: a room whose water becomes unstable is restored, reports it, and sends no
// invalid values.
#include <chrono>
#include <cstdio>
#include <thread>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

/// A third too few wave steps: Courant number 0.73 instead of at most 0.707, and a splash at the start. The water is
/// deep, because no cell gives more than it holds: shallow water would oscillate within bounds without end.
constexpr const char* kUnstable = R"(
  wave { resolution_count: 64 side_m: 22.4 depth_m: 24 fixed_substeps_count: 1 }
  allow_unstable: true
  stream { frame_rate_hz: 60 }
  events { at_s: 0.2 effect { splash { radius_m: 1 depth_m: 0.5 duration_s: 0.1 } } }
)";

/// Cells a third as wide: Courant number 2.1, unstable with half the step, too.
constexpr const char* kHopeless = R"(
  wave { resolution_count: 64 side_m: 8 depth_m: 24 fixed_substeps_count: 1 }
  allow_unstable: true
  stream { frame_rate_hz: 60 }
)";

class Watchdog : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", kUnstable}, {"calm", kStillWave}, {"hopeless", kHopeless}};
  }
};

TEST_F(Watchdog, ReportsARecoveryAndTheRoomContinues) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ScriptedClient elsewhere = client("calm");
  const auto recovered = [](const v1::ServerMessage& m) {
    return m.has_room_event() && m.room_event().kind() == v1::ROOM_EVENT_KIND_RECOVERED;
  };
  std::uint64_t tick = 0;
  for (ScriptedClient* each : {&one, &two}) {
    const auto news = each->waitFor(recovered);
    ASSERT_TRUE(news) << "the watchdog never stepped in";
    EXPECT_GT(news->room_event().tick(), 12u) << "not before the splash";
    EXPECT_THAT(news->room_event().message(), testing::HasSubstr("1 times"));
    tick = news->room_event().tick();
  }
  // Water at rest again, or nearly: clients do not see the unstable water.
  one.subscribe(v1::LAYER_SURFACE);
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  for (int frame = 0; frame < 10; ++frame) {
    const auto next = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(next);
    EXPECT_GT(next->tick(), tick);
    const double max_m = maxElevation_m(*next);
    EXPECT_GE(max_m, 0.0) << "decodes";
    EXPECT_LT(max_m, 24.0) << "what trips the watchdog is five times as high";
  }
  const auto message = one.waitFor(v1::ServerMessage::kDiagnostics);
  ASSERT_TRUE(message);
  EXPECT_GE(message->diagnostics().recovered_count(), 1u);
  EXPECT_GT(message->diagnostics().nonfinite_count(), 0u);
  EXPECT_TRUE(one.apply(splash(0.3, 0.5))) << "commands continue";
  EXPECT_FALSE(elsewhere.hasReceived(v1::ServerMessage::kRoomEvent));
}

TEST_F(Watchdog, ReportsEachFurtherIntervention) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(setSpeed(4)));
  const auto recovered = [](const char* times) {
    return [times](const v1::ServerMessage& m) {
      return m.has_room_event() && m.room_event().kind() == v1::ROOM_EVENT_KIND_RECOVERED &&
             m.room_event().message().find(times) != std::string::npos;
    };
  };
  ASSERT_TRUE(one.waitFor(recovered("1 times")));
  ASSERT_TRUE(one.apply(splash(0.5, 1.0)));
  EXPECT_TRUE(one.waitFor(recovered("2 times"))) << "the careful seconds are over, the step is too long again";
}

TEST_F(Watchdog, ReportsAtMostOncePerSecond) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  ScriptedClient one = client("hopeless");
  while (Clock::now() - begin < std::chrono::seconds(4)) {
    ASSERT_TRUE(one.apply(splash(0.5, 1.0)));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  int told = 0;
  while (one.hasReceived(v1::ServerMessage::kRoomEvent)) {
    const auto news = one.waitFor(v1::ServerMessage::kRoomEvent);
    ASSERT_TRUE(news);
    told += news->room_event().kind() == v1::ROOM_EVENT_KIND_RECOVERED ? 1 : 0;
  }
  // Counted over the whole time, so that a late message does not count as an early one.
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto message = one.waitFor(v1::ServerMessage::kDiagnostics);
  ASSERT_TRUE(message);
  std::printf("%d messages in %.1f s, the watchdog stepped in %llu times\n", told, elapsed_s,
              static_cast<unsigned long long>(message->diagnostics().recovered_count()));
  EXPECT_GE(told, 2);
  EXPECT_LE(told, static_cast<int>(elapsed_s) + 1);
  EXPECT_GT(message->diagnostics().recovered_count(), static_cast<std::uint64_t>(2 * told))
      << "or nothing was held back";
}

}  // namespace
}  // namespace spindrift::test
