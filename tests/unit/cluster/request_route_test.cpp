// Which server of the cluster answers a request: decided from what a process has heard.
#include "request_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spindrift::cluster {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

const Clock::time_point kRouteStart{seconds(1'000)};

class RequestRouteTest : public ::testing::Test {
 protected:
  RequestRouteTest() {
    note("a", 0.5, "main");
    note("b", 0.1, "lab");
  }
  void note(const std::string& server, double load, const std::string& room, unsigned room_max_count = 8) {
    v1::ServerPulse pulse;
    pulse.set_server(server);
    pulse.set_load(load);
    pulse.set_room_max_count(room_max_count);
    pulse.add_rooms(room);
    servers_.note(std::move(pulse), kRouteStart);
  }
  RequestRoute route(const std::string& method, const std::string& rest, Clock::time_point now = kRouteStart) const {
    return routeOf({.method = method, .path = std::string(kApi) + rest, .query = {}, .body = {}},
                   {.servers = servers_,
                    .self = self_,
                    .is_server = is_server_,
                    .has_heard_all = has_heard_all_,
                    .runs = [](const std::string& room) { return room == "main"; }},
                   now);
  }
  /// Returns the server that is asked; empty: it is another kind of route.
  std::string asked(const std::string& method, const std::string& rest) const {
    const RequestRoute found = route(method, rest);
    const auto* const ask = std::get_if<Ask>(&found);
    return ask != nullptr ? ask->server : "";
  }
  unsigned status(const std::string& method, const std::string& rest, Clock::time_point now = kRouteStart) const {
    const RequestRoute found = route(method, rest, now);
    const auto* const reply = std::get_if<net::HttpReply>(&found);
    return reply != nullptr ? reply->status : 0;
  }

  Servers servers_;
  std::string self_ = "e";
  bool is_server_ = false;
  bool has_heard_all_ = true;
};

TEST_F(RequestRouteTest, EdgeAsksTheServerOfTheRoom) {
  EXPECT_EQ(asked("GET", "rooms/main"), "a");
  EXPECT_EQ(asked("POST", "rooms/lab/commands"), "b");
}

TEST_F(RequestRouteTest, EdgeAsksTheLeastLoadedServerForANewRoom) {
  EXPECT_EQ(asked("POST", "rooms"), "b");
}

TEST_F(RequestRouteTest, EdgeAsksAnyServerForAnUnknownRoom) {
  EXPECT_EQ(asked("GET", "rooms/nowhere"), "a");
  EXPECT_EQ(asked("GET", "scenes"), "b");
}

TEST_F(RequestRouteTest, ListOfRoomsAsksAll) {
  EXPECT_TRUE(std::holds_alternative<AskAll>(route("GET", "rooms")));
  is_server_ = true;
  EXPECT_TRUE(std::holds_alternative<AskAll>(route("GET", "rooms")));
}

TEST_F(RequestRouteTest, ServerAnswersForItsRoomsAndForAllServers) {
  is_server_ = true;
  self_ = "a";
  EXPECT_TRUE(std::holds_alternative<Here>(route("DELETE", "rooms/main")));
  EXPECT_TRUE(std::holds_alternative<Here>(route("GET", "rooms/nowhere")));
  EXPECT_TRUE(std::holds_alternative<Here>(route("GET", "scenes")));
  EXPECT_EQ(asked("GET", "rooms/lab"), "b");
  EXPECT_EQ(asked("POST", "rooms"), "b");
}

TEST_F(RequestRouteTest, UnreachableRoomIsAnswered503WithRetryAfter) {
  const auto later = kRouteStart + kServerPatience + milliseconds(1);
  EXPECT_EQ(status("GET", "rooms/main", later), 503U) << "its server is dead";
  has_heard_all_ = false;
  EXPECT_EQ(status("GET", "rooms/nowhere"), 503U) << "another server may have it";
  const RequestRoute found = route("GET", "rooms/nowhere");
  EXPECT_THAT(std::get<net::HttpReply>(found).headers, testing::Contains(testing::Pair("Retry-After", "1")));
}

TEST_F(RequestRouteTest, NewRoomIsRefusedAtTheLimitOfEveryServer) {
  note("a", 0.5, "main", 1);
  note("b", 0.1, "lab", 1);
  EXPECT_EQ(status("POST", "rooms"), 503U);
  const RequestRoute found = route("POST", "rooms");
  EXPECT_THAT(std::get<net::HttpReply>(found).body, HasSubstr("limit of rooms"));
}

}  // namespace
}  // namespace spindrift::cluster
