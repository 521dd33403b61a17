// Gauges that people put into the water, over real connections: who sees them, what they read, and their bounds.
#include <algorithm>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/v1/api.pb.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kGaugedBay = R"(
  wave { resolution_count: 64 side_m: 12 depth_m: 1 }
  gauges { name: "near" x_m: -3 z_m: 1.25 }
  gauges { name: "G2" x_m: 3 }
  stream { frame_rate_hz: 60 }
)";
constexpr const char* kGaugeOperator = "operator-operator-1";
constexpr const char* kGaugeViewer = "viewer-viewer-viewer-1";

/// Guests are players, and are gone a moment after their connection.
class PlacedGauges : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    std::string full = kStillWave;
    for (int k = 0; k < 63; ++k) full += fmt::format("gauges {{ name: \"g{}\" }}\n", k);
    return {{"main", kGaugedBay}, {"plain", kStillWave}, {"full", full}, {"box", "particles {}"}};
  }
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(fmt::format("operator {}\nviewer {}\n", kGaugeOperator, kGaugeViewer), "tokens",
                                        core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
    options.rules.grace = std::chrono::milliseconds(50);
  }

  HttpAnswer get(const std::string& path) { return httpRequest(server().port(), "GET", path, "", ""); }
  boost::json::value series(const std::string& room, const std::string& gauge) {
    const HttpAnswer answer = get("/api/v1/rooms/" + room + "/gauges/" + gauge);
    EXPECT_EQ(answer.status, 200U) << answer.body;
    return boost::json::parse(answer.body);
  }
};

/// Returns the next diagnostics that `wanted` accepts; subscribes first.
v1::Diagnostics diagnosticsWhen(ScriptedClient& client, const std::function<bool(const v1::Diagnostics&)>& wanted) {
  client.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto message = client.waitFor([&](const v1::ServerMessage& candidate) {
    return candidate.has_diagnostics() && wanted(candidate.diagnostics());
  });
  if (!message) ADD_FAILURE() << "no such diagnostics came";
  return message ? message->diagnostics() : v1::Diagnostics();
}

const v1::GaugeReading* findGauge(const v1::Diagnostics& diagnostics, std::uint32_t gauge_id) {
  const auto found = std::ranges::find(diagnostics.gauges(), gauge_id, &v1::GaugeReading::gauge_id);
  return found != diagnostics.gauges().end() ? &*found : nullptr;
}

std::vector<std::string> gaugeNamesOf(const v1::Diagnostics& diagnostics) {
  std::vector<std::string> out;
  for (const v1::GaugeReading& gauge : diagnostics.gauges()) out.push_back(gauge.name());
  return out;
}

std::uint32_t placedBy(ScriptedClient& client, double x_m = 0.0, double z_m = 0.0) {
  const v1::ServerMessage answer = client.ask(placeGauge(x_m, z_m));
  EXPECT_TRUE(answer.has_ack()) << answer.reject().message();
  return answer.ack().gauge_id();
}

TEST_F(PlacedGauges, AreSeenByAllAndReadWhatTheSceneReadsThere) {
  ScriptedClient ada = client();
  ScriptedClient watcher = person({.token = kGaugeViewer});
  EXPECT_GE(ada.greeting().version().minor(), 9u);
  ASSERT_TRUE(ada.apply(splash()));
  const std::uint32_t first = placedBy(ada, -3, 1.25);
  const std::uint32_t second = placedBy(ada, 4, 0);
  EXPECT_EQ(ada.ask(splash(0.1)).ack().gauge_id(), 0u) << "the id belongs to one answer only";
  const v1::Diagnostics seen = diagnosticsWhen(watcher, [&](const v1::Diagnostics& now) {
    return findGauge(now, second) && !findGauge(now, second)->unread() && now.gauges_time_s() > 1;
  });
  EXPECT_THAT(gaugeNamesOf(seen), ElementsAre("near", "G2", "G1", "G3")) << "the scene has a G2";
  const v1::GaugeReading own = *findGauge(seen, first);
  EXPECT_EQ(own.person_id(), ada.welcome().person_id());
  EXPECT_EQ(own.x_m(), -3.0);
  EXPECT_EQ(own.z_m(), 1.25);
  EXPECT_EQ(seen.gauges(0).x_m(), -3.0);
  EXPECT_EQ(seen.gauges(0).gauge_id(), 0u);
  EXPECT_EQ(own.elevation_m(), seen.gauges(0).elevation_m());
  EXPECT_NE(own.elevation_m(), 0.0);

  const boost::json::value of_scene = series("main", "near");
  const boost::json::value of_ada = series("main", "G1");
  EXPECT_EQ(of_ada.at("x_m").to_number<double>(), -3.0);
  const auto& times_s = of_ada.at("time_s").as_array();
  const auto& all_s = of_scene.at("time_s").as_array();
  ASSERT_GT(times_s.size(), 10u);
  EXPECT_LT(times_s.size(), all_s.size()) << "it begins when it was placed";
  const auto begin = std::ranges::find(all_s, times_s[0]) - all_s.begin();
  for (std::size_t k = 0; k < times_s.size() && begin + k < all_s.size(); ++k) {
    ASSERT_EQ(times_s[k], all_s[begin + k]) << k;
    ASSERT_EQ(of_ada.at("elevation_m").as_array()[k], of_scene.at("elevation_m").as_array()[begin + k]) << k;
  }
  EXPECT_THAT(get("/api/v1/rooms/main/gauges").body, HasSubstr("\"G3\""));
  EXPECT_THAT(get("/metrics").body, testing::AllOf(HasSubstr("gauge=\"near\""), Not(HasSubstr("gauge=\"G1\""))));
  EXPECT_THAT(get("/api/v1/rooms/main/scene").body, Not(HasSubstr("\"G1\"")));
}

TEST_F(PlacedGauges, WorkInASceneWithoutGaugesAndStayOverAReset) {
  ScriptedClient chief = person({.token = kGaugeOperator}, "plain");
  const std::uint32_t id = placedBy(chief, 1, 1);
  const auto isRead = [&](const v1::Diagnostics& now) { return findGauge(now, id) && !findGauge(now, id)->unread(); };
  EXPECT_GT(diagnosticsWhen(chief, isRead).gauges_time_s(), 0.0);
  ASSERT_TRUE(chief.runFor(90));
  const auto ticks = [&] { return series("plain", "G1").at("time_s").as_array().size(); };
  EXPECT_GT(ticks(), 60u);
  ASSERT_TRUE(chief.apply(setPaused(true)));
  ASSERT_TRUE(chief.apply(reset()));
  EXPECT_EQ(ticks(), 0u) << "it records anew";
  const v1::Diagnostics paused = diagnosticsWhen(chief, [&](const v1::Diagnostics& now) { return now.time_s() == 0; });
  ASSERT_TRUE(findGauge(paused, id));
  EXPECT_TRUE(findGauge(paused, id)->unread());
  const std::uint32_t another = placedBy(chief, 2, 2);
  const v1::Diagnostics both =
      diagnosticsWhen(chief, [&](const v1::Diagnostics& now) { return findGauge(now, another) != nullptr; });
  EXPECT_TRUE(findGauge(both, another)->unread()) << "seen while the water stands still";
}

TEST_F(PlacedGauges, AreBoundedPerPersonAndRoom) {
  ScriptedClient ada = client();
  std::vector<std::uint32_t> ids;
  for (int k = 0; k < 4; ++k) ids.push_back(placedBy(ada, 0.5 * k));
  const v1::Reject fifth = ada.rejected(placeGauge(0, 0));
  EXPECT_EQ(fifth.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_EQ(fifth.field(), "place_gauge");
  EXPECT_THAT(fifth.message(), HasSubstr("you have 4 gauges in the water, 4 are the most: remove one first"));
  ASSERT_TRUE(ada.apply(removeGauge(ids[1])));
  EXPECT_GT(placedBy(ada), ids.back()) << "ids and names are not used again";

  ScriptedClient bob = client("full");
  ScriptedClient eve = client("full");
  EXPECT_NE(placedBy(bob), 0u);
  const v1::Reject full = eve.rejected(placeGauge(0, 0));
  EXPECT_EQ(full.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_THAT(full.message(), HasSubstr("the room has 64 gauges, 64 are the most"));
}

TEST_F(PlacedGauges, AreRefusedOutsideOfTheWaterAndWhereThereIsNone) {
  ScriptedClient ada = client();
  const v1::Reject outside = ada.rejected(placeGauge(0, 6.5));
  EXPECT_EQ(outside.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(outside.field(), "place_gauge.z_m");
  EXPECT_THAT(outside.message(), HasSubstr("6.5 m"));
  EXPECT_EQ(ada.rejected(placeGauge(std::nan(""), 0)).reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(ada.rejected(placeGauge(1e9, 0)).field(), "place_gauge.x_m");
  EXPECT_NE(placedBy(ada, 6, -6), 0u) << "the edge belongs to the water";
  ScriptedClient bob = client("box");
  const v1::Reject dry = bob.rejected(placeGauge(0, 0));
  EXPECT_EQ(dry.reason(), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_THAT(dry.message(), HasSubstr("no wave"));
}

TEST_F(PlacedGauges, BelongToWhoPlacedThem) {
  ScriptedClient ada = client();
  ScriptedClient bob = client();
  const std::uint32_t id = placedBy(ada);
  EXPECT_EQ(bob.rejected(removeGauge(id)).reason(), v1::REJECT_REASON_NOT_YOURS);
  EXPECT_EQ(ada.rejected(removeGauge(id + 1)).reason(), v1::REJECT_REASON_UNKNOWN_GAUGE);
  EXPECT_EQ(ada.rejected(removeGauge(0)).field(), "remove_gauge.gauge_id") << "the scene's stay";
  ScriptedClient chief = person({.token = kGaugeOperator});
  EXPECT_TRUE(chief.apply(removeGauge(id)));
  EXPECT_EQ(get("/api/v1/rooms/main/gauges/G1").status, 404U);
  ScriptedClient watcher = person({.token = kGaugeViewer});
  EXPECT_EQ(watcher.rejected(placeGauge(0, 0)).reason(), v1::REJECT_REASON_FORBIDDEN);
  const HttpAnswer nobody = httpRequest(server().port(), "POST", "/api/v1/rooms/main/commands",
                                        "Content-Type: application/json\r\n", R"({"place_gauge": {"x_m": 1}})");
  EXPECT_EQ(nobody.status, 403U);
  EXPECT_THAT(nobody.body, HasSubstr("only somebody in the room can place a gauge"));
}

TEST_F(PlacedGauges, GoWhenTheirOwnerIsGone) {
  ScriptedClient bob = client();
  const std::uint32_t bobs = placedBy(bob, 1);
  {
    ScriptedClient ada = client();
    const std::uint32_t adas = placedBy(ada, 2);
    diagnosticsWhen(bob, [&](const v1::Diagnostics& now) { return findGauge(now, adas) != nullptr; });
    ada.ws().vanish();
  }
  const v1::Diagnostics alone = diagnosticsWhen(bob, [](const v1::Diagnostics& now) { return now.gauges_size() == 3; });
  EXPECT_TRUE(findGauge(alone, bobs));
}

}  // namespace
}  // namespace spindrift::test
