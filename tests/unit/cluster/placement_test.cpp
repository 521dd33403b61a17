// Where rooms run: decisions from pulses alone, without a clock or a network.
#include "placement.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spindrift::cluster {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

const Clock::time_point kStart{seconds(1'000)};
/// Later than the pulses of a server that is alive.
const Clock::time_point kLater = kStart + kServerPatience + milliseconds(1);

v1::ServerPulse pulse(const std::string& server, double load = 0, const std::vector<std::string>& rooms = {},
                      unsigned room_max_count = 8) {
  v1::ServerPulse out;
  out.set_server(server);
  out.set_load(load);
  out.set_room_max_count(room_max_count);
  for (const std::string& room : rooms) out.add_rooms(room);
  return out;
}

TEST(Servers, AreAliveUntilTheirPulseIsTooOld) {
  Servers servers;
  servers.note(pulse("a"), kStart);
  servers.note(pulse("b"), kStart + milliseconds(500));
  EXPECT_TRUE(servers.isAlive("a", kStart + kServerPatience));
  EXPECT_FALSE(servers.isAlive("a", kLater));
  EXPECT_FALSE(servers.isAlive("c", kStart)) << "never heard of";
  EXPECT_THAT(servers.alive(kStart + kServerPatience), ElementsAre("a", "b"));
  EXPECT_THAT(servers.alive(kLater), ElementsAre("b"));
  servers.note(pulse("a"), kLater);
  EXPECT_THAT(servers.alive(kLater), ElementsAre("a", "b")) << "back";
}

TEST(Servers, AreForgottenAMinuteAfterTheirLastPulse) {
  Servers servers;
  servers.note(pulse("a", 0, {"main"}), kStart);
  servers.review(kStart + seconds(60));
  EXPECT_EQ(servers.serverOf("main"), "a");
  servers.review(kStart + seconds(60) + milliseconds(1));
  EXPECT_EQ(servers.serverOf("main"), "");
  EXPECT_THAT(servers.rooms(), IsEmpty());
}

TEST(Servers, NamesThatNoneCanHaveAreLeftOut) {
  Servers servers;
  servers.note(pulse("a b", 0, {"main"}), kStart);
  servers.note(pulse("a", 0, {"q\"} 1", "quay", "two\nlines"}), kStart);
  EXPECT_THAT(servers.alive(kStart), ElementsAre("a"));
  EXPECT_THAT(servers.rooms(), ElementsAre("quay"));
}

TEST(NewRoom, GoesToTheLeastLoadedServer) {
  Servers servers;
  EXPECT_EQ(servers.choose(kStart), "") << "there is no server";
  servers.note(pulse("a", 0.5), kStart);
  servers.note(pulse("b", 0.2), kStart);
  servers.note(pulse("c", 0.9), kStart);
  EXPECT_EQ(servers.choose(kStart), "b");
  servers.note(pulse("b", 0.6), kStart);
  EXPECT_EQ(servers.choose(kStart), "a") << "the newest pulse counts";
}

TEST(NewRoom, AvoidsDeadLeavingAndFullServers) {
  Servers servers;
  servers.note(pulse("dead", 0.1), kStart);
  v1::ServerPulse leaving = pulse("leaving", 0.2);
  leaving.set_is_leaving(true);
  servers.note(leaving, kLater);
  servers.note(pulse("full", 0.3, {"main", "pool"}, 2), kLater);
  EXPECT_EQ(servers.choose(kLater), "");
  servers.note(pulse("busy", 0.9), kLater);
  EXPECT_EQ(servers.choose(kLater), "busy");
}

TEST(NewRoom, CountsRoomsPlacedSinceTheLastPulse) {
  Servers servers;
  servers.note(pulse("a", 0.1, {"main"}, 3), kStart);
  servers.note(pulse("b", 0.3), kStart);
  EXPECT_EQ(servers.choose(kStart), "a");
  EXPECT_EQ(servers.choose(kStart, {{"a", 1}}), "b") << "one more room is more load than b has";
  EXPECT_EQ(servers.choose(kStart, {{"a", 1}, {"b", 1}}), "a");
  servers.note(pulse("b", 9), kStart);
  EXPECT_EQ(servers.choose(kStart, {{"a", 1}}), "a");
  EXPECT_EQ(servers.choose(kStart, {{"a", 2}}), "b") << "a has no place left";
}

TEST(RoomOfADeadServer, StaysKnownUntilAnotherServerHasIt) {
  Servers servers;
  servers.note(pulse("a", 0, {"main", "pool"}), kStart);
  servers.note(pulse("b", 0, {"lab"}), kStart);
  EXPECT_EQ(servers.serverOf("main"), "a");
  servers.note(pulse("b", 0, {"lab"}), kLater);
  EXPECT_FALSE(servers.isAlive(servers.serverOf("main"), kLater));
  EXPECT_THAT(servers.rooms(), ElementsAre("lab", "main", "pool")) << "it is to be opened again";
  servers.note(pulse("b", 0, {"lab", "main"}), kLater);
  EXPECT_EQ(servers.serverOf("main"), "b");
  EXPECT_EQ(servers.serverOf("pool"), "a") << "the other room still has no other server";
  EXPECT_THAT(servers.rooms(), ElementsAre("lab", "main", "pool"));
}

TEST(RoomOfADeadServer, StaysWithItsNewServer) {
  Servers servers;
  servers.note(pulse("a", 0, {"main"}), kStart);
  servers.note(pulse("b", 0, {"main"}), kLater);
  servers.note(pulse("a"), kLater + milliseconds(100));
  EXPECT_EQ(servers.serverOf("main"), "b");
}

TEST(RoomOfTwoServers, IsThatOfTheNewerPulse) {
  Servers servers;
  servers.note(pulse("a", 0, {"main"}), kStart);
  servers.note(pulse("b", 0, {"main"}), kStart + milliseconds(1));
  EXPECT_EQ(servers.serverOf("main"), "b") << "both are alive, and each speaks for itself";
  const auto now = kStart + milliseconds(2);
  EXPECT_TRUE(servers.runs("a", "main", now) && servers.runs("b", "main", now)) << "whoever was heard last";
  EXPECT_FALSE(servers.runs("b", "pool", now) || servers.runs("c", "main", now) ||
               servers.runs("b", "main", now + seconds(2)));
  EXPECT_THAT(servers.rooms(), ElementsAre("main"));
}

TEST(ClosedRoom, IsNoRoomAnyMore) {
  Servers servers;
  servers.note(pulse("a", 0, {"main", "pool"}), kStart);
  servers.note(pulse("a", 0, {"main"}), kStart);
  EXPECT_EQ(servers.serverOf("pool"), "");
  EXPECT_THAT(servers.rooms(), ElementsAre("main"));
}

TEST(AllServers, ChooseAlikeInAnyOrderOfPulses) {
  std::vector<v1::ServerPulse> pulses{pulse("c", 0.2), pulse("a", 0.2), pulse("d", 0.1, {"main"}, 1), pulse("b", 0.2)};
  const auto by_name = [](const auto& one, const auto& other) { return one.server() < other.server(); };
  std::ranges::sort(pulses, by_name);
  int order_count = 0;
  do {
    Servers servers;
    for (const auto& each : pulses) servers.note(each, kStart);
    EXPECT_EQ(servers.choose(kStart), "a") << "the first by name of those with the same load";
    EXPECT_EQ(servers.choose(kStart, {{"a", 1}}), "b");
    ++order_count;
  } while (std::next_permutation(pulses.begin(), pulses.end(), by_name));
  EXPECT_EQ(order_count, 24);
}

}  // namespace
}  // namespace spindrift::cluster
