#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "session_link.h"
#include "test_application.h"

namespace spindrift::net {
namespace {

using test::shared;

/// Records the hub's calls.
struct RecordingLink final : SessionLink {
  int control_count = 0;
  int frame_count = 0;
  int wake_count = 0;
  bool takes_frames = true;
  std::function<void()> on_write;
  int newest_count = 0;
  std::shared_ptr<core::DemandTable> demand;  ///< of its room
  std::optional<double> rate_hz;
  std::optional<CloseCode> closed;
  std::optional<CloseCode> closing_later;

  void sendAnswer(core::SharedBytes) override { ++control_count; }
  void sendState(const StateTopic&, core::SharedBytes) override { ++control_count; }
  void offerFrame(StreamIndex, const FrameBytes&, Wake wake) override {
    ++frame_count;
    if (wake == Wake::kNow) ++wake_count;
  }
  bool takesFrames() override { return takes_frames; }
  void writeNow() override {
    ++wake_count;
    if (on_write) on_write();
  }
  void offerNewest(StreamIndex, const FrameBytes&) override { ++newest_count; }
  void setWatch(StreamIndex, const std::optional<Watch>& watch) override {
    rate_hz = watch ? std::optional(watch->max_rate_hz) : std::nullopt;
  }
  void enterRoom(std::shared_ptr<core::DemandTable> of_room) override { demand = std::move(of_room); }
  Waiting waiting() const override { return {1, 2}; }
  void close(CloseCode code, std::string) override { closed = code; }
  void closeAt(std::chrono::steady_clock::time_point, CloseCode code, std::string) override { closing_later = code; }
};

struct RoomHubTest : testing::Test {
  test::DemandTables demands;
  Hub hub;
  std::shared_ptr<RecordingLink> ada = std::make_shared<RecordingLink>();
  std::shared_ptr<RecordingLink> bob = std::make_shared<RecordingLink>();

  void SetUp() override {
    hub.add(1, ada);
    hub.add(2, bob);
  }
};

TEST_F(RoomHubTest, OffersTheNewestFrameToTheWatchersOfItsStream) {
  hub.join(1, "pool", demands.of("pool"));
  hub.join(2, "pool", demands.of("pool"));
  hub.watch(1, 3, {.max_rate_hz = 30.0});
  hub.watch(2, 4, {.max_rate_hz = 30.0});
  hub.offerNewest("pool", 3, {.keyframe = shared("newest"), .delta = nullptr});
  hub.offerNewest("pond", 3, {.keyframe = shared("newest"), .delta = nullptr});
  EXPECT_EQ(ada->newest_count, 1);
  EXPECT_EQ(bob->newest_count, 0);
  EXPECT_EQ(ada->frame_count, 0);
}

TEST_F(RoomHubTest, PublishesToTheWatchersOfTheRoomAndLayerOnly) {
  hub.join(1, "pool", demands.of("pool"));
  hub.join(2, "sea", demands.of("sea"));
  hub.watch(1, 3, {.max_rate_hz = 30.0});
  hub.watch(2, 3, {.max_rate_hz = 30.0});
  hub.publish("pool", 3, {shared("frame"), {}});
  hub.publish("pool", 4, {shared("frame"), {}});
  hub.publish("pond", 3, {shared("frame"), {}});
  EXPECT_EQ(ada->frame_count, 1);
  EXPECT_EQ(bob->frame_count, 0);
}

/// A hub whose delayed calls are made by the test.
struct GatheringHub {
  test::DemandTables demands;
  Hub hub;
  std::vector<std::function<void()>> later;
  int task_count = 0;
  std::vector<std::shared_ptr<RecordingLink>> links;

  GatheringHub() {
    hub.gatherFrames([this](std::function<void()> wake) { later.push_back(std::move(wake)); },
                     [this](const std::function<void()>& write) {
                       ++task_count;
                       write();
                     });
  }
  void addToPool(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      links.push_back(std::make_shared<RecordingLink>());
      hub.add(links.size(), links.back());
      hub.join(links.size(), "pool", demands.of("pool"));
      hub.watch(links.size(), 3, {.max_rate_hz = 30.0});
      hub.watch(links.size(), 4, {.max_rate_hz = 30.0});
    }
  }
  [[nodiscard]] bool allWere(int offered, int woken) const {
    return std::ranges::all_of(
        links, [&](const auto& link) { return link->frame_count == offered && link->wake_count == woken; });
  }
};

TEST(RoomHubGathers, AFewSessionsAreWokenByEveryFrame) {
  GatheringHub test;
  test.addToPool(Hub::kGatherSessionCount - 1);
  test.hub.publish("pool", 3, {shared("surface"), {}});
  test.hub.publish("pool", 4, {shared("foam"), {}});
  EXPECT_TRUE(test.allWere(2, 2));
  EXPECT_TRUE(test.later.empty());
}

TEST(RoomHubGathers, ManySessionsAreWokenOnceForTheFramesOfAMoment) {
  GatheringHub test;
  test.addToPool(Hub::kGatherSessionCount);
  test.hub.publish("pool", 3, {shared("surface"), {}});
  test.hub.publish("pool", 4, {shared("foam"), {}});
  EXPECT_TRUE(test.allWere(2, 0));
  ASSERT_EQ(test.later.size(), 1U);
  test.later[0]();
  EXPECT_TRUE(test.allWere(2, 1));
  test.hub.publish("pool", 3, {shared("next surface"), {}});
  ASSERT_EQ(test.later.size(), 2U) << "the next moment is waited for anew";
  test.later[1]();
  EXPECT_TRUE(test.allWere(3, 2));
}

TEST(RoomHubGathers, OneTaskWritesForSeveralSessionsThatHaveFrames) {
  GatheringHub test;
  test.addToPool(Hub::kGatherSessionCount);
  test.links[3]->takes_frames = false;
  test.hub.publish("pool", 3, {shared("surface"), {}});
  test.later.at(0)();
  EXPECT_EQ(test.task_count, static_cast<int>(Hub::kGatherSessionCount / Hub::kWokenTogetherCount));
  EXPECT_EQ(test.links[3]->wake_count, 0);
  EXPECT_EQ(test.links[4]->wake_count, 1);
}

TEST(RoomHubGathers, WritesWithoutTheHubsLock) {
  GatheringHub test;
  test.addToPool(Hub::kGatherSessionCount);
  std::size_t room_count = 0;
  test.links[0]->on_write = [&] { room_count = test.hub.roomCount(); };
  test.hub.publish("pool", 3, {shared("surface"), {}});
  test.later.at(0)();
  EXPECT_EQ(room_count, 1U);
}

TEST(RoomHubGathers, ALateWakeUpFindsTheRoomGone) {
  GatheringHub test;
  test.addToPool(Hub::kGatherSessionCount);
  test.hub.publish("pool", 3, {shared("surface"), {}});
  for (SessionId session = 1; session <= Hub::kGatherSessionCount; ++session) test.hub.remove(session);
  ASSERT_EQ(test.later.size(), 1U);
  test.later[0]();
  EXPECT_TRUE(test.allWere(1, 0));
}

TEST_F(RoomHubTest, ChangesAndStopsWatches) {
  hub.join(1, "pool", demands.of("pool"));
  hub.watch(1, 3, {.max_rate_hz = 10.0});
  hub.watch(1, 3, {.max_rate_hz = 20.0});
  hub.publish("pool", 3, {shared("frame"), {}});
  EXPECT_EQ(ada->rate_hz, 20.0);
  EXPECT_EQ(ada->frame_count, 1) << "it watches once";
  for (const double rate_hz :
       {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    hub.watch(1, 3, {.max_rate_hz = 20.0});
    hub.watch(1, 3, {.max_rate_hz = rate_hz});
    hub.publish("pool", 3, {shared("frame"), {}});
    EXPECT_EQ(ada->rate_hz, std::nullopt) << rate_hz;
    EXPECT_EQ(ada->frame_count, 1) << rate_hz;
  }
}

TEST_F(RoomHubTest, MovesWatchesToAnotherRoom) {
  hub.watch(1, 3, {.max_rate_hz = 30.0});
  hub.join(1, "pool", demands.of("pool"));
  EXPECT_EQ(ada->demand, demands.of("pool"));
  hub.join(1, "sea", demands.of("sea"));
  EXPECT_EQ(ada->demand, demands.of("sea"));
  hub.publish("pool", 3, {shared("frame"), {}});
  EXPECT_EQ(ada->frame_count, 0);
  hub.publish("sea", 3, {shared("frame"), {}});
  EXPECT_EQ(ada->frame_count, 1);
  hub.remove(1);
  EXPECT_EQ(ada->demand, nullptr);
}

TEST_F(RoomHubTest, ForgetsEmptyRooms) {
  for (int k = 0; k < 100; ++k) hub.join(1, "room " + std::to_string(k), demands.of("room " + std::to_string(k)));
  hub.join(2, "room 99", demands.of("room 99"));
  EXPECT_EQ(hub.roomCount(), 1U);
  hub.remove(1);
  EXPECT_EQ(hub.roomCount(), 1U);
  hub.remove(2);
  EXPECT_EQ(hub.roomCount(), 0U);
}

TEST_F(RoomHubTest, IgnoresSessionsThatAreGone) {
  hub.join(1, "pool", demands.of("pool"));
  hub.watch(1, 3, {.max_rate_hz = 30.0});
  hub.remove(1);
  hub.remove(1);
  hub.join(1, "pool", demands.of("pool"));
  hub.watch(1, 3, {.max_rate_hz = 30.0});
  hub.sendAnswer(1, shared("control"));
  hub.close(1, CloseCode::kNormal, "");
  hub.publish("pool", 3, {shared("frame"), {}});
  EXPECT_EQ(ada->control_count + ada->frame_count, 0);
  EXPECT_EQ(ada->closed, std::nullopt);
  EXPECT_EQ(ada.use_count(), 1) << "the hub released the session";
}

TEST_F(RoomHubTest, ReachesOneSession) {
  hub.sendAnswer(2, shared("control"));
  hub.close(2, CloseCode::kPolicy, "because");
  EXPECT_EQ(bob->control_count, 1);
  EXPECT_EQ(bob->closed, CloseCode::kPolicy);
  EXPECT_EQ(ada->control_count, 0);
  EXPECT_EQ(ada->closed, std::nullopt);
}

}  // namespace
}  // namespace spindrift::net
