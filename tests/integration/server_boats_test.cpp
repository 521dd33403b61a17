// Boats over a real connection: which clients get the boat list, and which commands are refused.
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHarbour = R"(
  wave { resolution_count: 32 side_m: 16 depth_m: 1 }
  obstacles { rock { x_m: 5 } }
  boats { capacity_count: 2 boats { x_m: -4 height_m: 0.5 density_ratio: 0.5 } }
  stream { frame_rate_hz: 60 }
)";

class Boats : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kHarbour}}; }
};
class NoBoats : public WaveServerTest {};

std::vector<std::uint32_t> idsOf(const v1::BoatList& list) {
  std::vector<std::uint32_t> ids;
  for (const v1::BoatInfo& boat : list.boats()) ids.push_back(boat.boat_id());
  return ids;
}

std::vector<std::uint32_t> nextList(ScriptedClient& client) {
  const auto message = client.waitFor(v1::ServerMessage::kBoatList);
  if (!message) return {99};
  return idsOf(message->boat_list());
}

TEST_F(Boats, GreetingListsTheBoatsOfTheScene) {
  const ScriptedClient one = client();
  EXPECT_THAT(one.greeting().layers(), ElementsAre(v1::LAYER_SURFACE, v1::LAYER_BODIES, v1::LAYER_DIAGNOSTICS));
  ASSERT_EQ(one.greeting().boat_list().boats_size(), 1);
  const v1::BoatInfo& boat = one.greeting().boat_list().boats(0);
  EXPECT_EQ(boat.boat_id(), 1u);
  EXPECT_EQ(boat.length_m(), 2.4);
  EXPECT_NEAR(boat.draught_m(), 0.25, 0.1);
}

TEST_F(Boats, SpawnAndRemoveAreSentToAllClients) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  const v1::ServerMessage spawned = one.ask(spawnBoat(0, 4));
  ASSERT_TRUE(spawned.has_ack()) << spawned.reject().message();
  EXPECT_EQ(spawned.ack().boat_id(), 2u);
  EXPECT_THAT(nextList(one), ElementsAre(1u, 2u));
  EXPECT_THAT(nextList(two), ElementsAre(1u, 2u));
  EXPECT_THAT(idsOf(client().greeting().boat_list()), ElementsAre(1u, 2u)) << "newcomers learn it from the greeting";

  EXPECT_TRUE(one.apply(controlBoat(2, 1, -0.5)));
  ASSERT_TRUE(two.apply(removeBoat(1)));
  EXPECT_THAT(nextList(one), ElementsAre(2u));
  EXPECT_THAT(nextList(two), ElementsAre(2u));
}

TEST_F(Boats, BeyondTheCapacityAreRefused) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(spawnBoat(0, 4)));
  const v1::Reject full = one.rejected(spawnBoat(0, -4));
  EXPECT_EQ(full.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_EQ(full.field(), "spawn_boat");
  ASSERT_TRUE(one.apply(removeBoat(1)));
  EXPECT_TRUE(one.apply(spawnBoat(0, -4))) << "a place became free";
}

TEST_F(Boats, UnknownIdsAreRejectedAndNamed) {
  ScriptedClient one = client();
  const v1::Reject control = one.rejected(controlBoat(77, 1, 0));
  EXPECT_EQ(control.reason(), v1::REJECT_REASON_UNKNOWN_BOAT);
  EXPECT_EQ(control.field(), "control_boat.boat_id");
  EXPECT_THAT(control.message(), HasSubstr("77"));
  const v1::Reject remove = one.rejected(removeBoat(0));
  EXPECT_EQ(remove.reason(), v1::REJECT_REASON_UNKNOWN_BOAT);
  EXPECT_EQ(remove.field(), "remove_boat.boat_id");
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kBoatList));
}

TEST_F(Boats, AreRefusedOutsideTheWaterAndInObstacles) {
  ScriptedClient one = client();
  EXPECT_EQ(one.rejected(spawnBoat(20, 0)).field(), "spawn_boat.boat.x_m");
  EXPECT_THAT(one.rejected(spawnBoat(5, 0)).message(), HasSubstr("obstacles[0]"));
  EXPECT_EQ(one.rejected(setParameter("wave.depth_m", 0.2)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST_F(Boats, ResetRestoresTheBoatsOfTheStart) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ASSERT_TRUE(one.apply(spawnBoat(0, 4)));
  EXPECT_THAT(nextList(two), ElementsAre(1u, 2u));
  const auto applied = one.apply(reset());
  ASSERT_TRUE(applied);
  const auto event = two.waitFor(v1::ServerMessage::kRoomEvent);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->room_event().kind(), v1::ROOM_EVENT_KIND_RESET);
  EXPECT_EQ(event->room_event().tick(), *applied);
  EXPECT_FALSE(event->room_event().message().empty());
  EXPECT_EQ(nextList(two).size(), 1u);
}

TEST_F(Boats, IdsSurviveAResetAndAreNeverReused) {
  ScriptedClient one = client();
  EXPECT_EQ(one.ask(spawnBoat(0, 4)).ack().boat_id(), 2u);
  EXPECT_THAT(nextList(one), ElementsAre(1u, 2u));
  ASSERT_TRUE(one.apply(reset()));
  EXPECT_THAT(nextList(one), ElementsAre(1u)) << "the scene's own is the same boat as before";
  EXPECT_EQ(one.rejected(controlBoat(2, 1, 0)).reason(), v1::REJECT_REASON_UNKNOWN_BOAT);
  EXPECT_EQ(one.ask(spawnBoat(0, 4)).ack().boat_id(), 3u) << "2 was another boat";
  ASSERT_TRUE(one.apply(removeBoat(3)));
  EXPECT_EQ(one.ask(spawnBoat(0, 4)).ack().boat_id(), 4u);
}

TEST_F(Boats, AreCountedByTheDiagnostics) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto message = one.waitFor(v1::ServerMessage::kDiagnostics);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->diagnostics().boat_count(), 1u);
}

TEST_F(NoBoats, ARoomWithoutBoatsRejectsBoatCommands) {
  ScriptedClient one = client();
  EXPECT_EQ(one.greeting().boat_list().boats_size(), 0);
  for (const v1::Command& command : {spawnBoat(0, 0), controlBoat(1, 0, 0), removeBoat(1)}) {
    const v1::Reject reject = one.rejected(command);
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_ABSENT_PART);
    EXPECT_THAT(reject.message(), HasSubstr("no boats"));
  }
}

}  // namespace
}  // namespace spindrift::test
