// Gauges and the ground of a room, as clients, scripts and scrapers get them.
#include <algorithm>

#include <boost/json.hpp>

#include <spindrift/script/script.h>
#include <spindrift/v1/api.pb.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

/// A splash at the gauge "near", whose water runs up a slope toward "shore".
constexpr const char* kBay = R"(
  wave { resolution_count: 64 side_m: 12 depth_m: 1 boundary_minus_x: WAVE_BOUNDARY_REFLECT
         boundary_plus_x: WAVE_BOUNDARY_REFLECT }
  bed { shapes { slope { x_m: 0 gradient_ratio: 0.25 } } }
  gauges { name: "near" x_m: -3 z_m: 0 }
  gauges { name: "shore" x_m: 3 z_m: 0 }
  stream { frame_rate_hz: 60 }
)";

class GaugesOfARoom : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", kBay}, {"plain", kStillPool}, {"box", "particles {}"}};
  }
  HttpAnswer get(const std::string& path) { return httpRequest(server().port(), "GET", path, "", ""); }
};

TEST_F(GaugesOfARoom, AreInTheDiagnosticsAndInAScript) {
  const auto script = script::parseScript(R"(
    steps { gauge { gauge: "near" min_m: -1e-6 max_m: 1e-6 } }
    steps { command { command { splash { x_m: -3 depth_m: 0.3 radius_m: 1 duration_s: 0.3 } } } }
    steps { gauge { gauge: "near" lowest_max_m: -0.03 highest_min_m: 0.01 within_s: 20 } }
    steps { gauge { gauge: "shore" highest_min_m: 0.002 within_s: 20 } }
    steps { gauge { gauge: "nowhere" min_m: 0 within_s: 0.3 } }
  )",
                                          "test");
  ASSERT_TRUE(script) << script.error().message;
  const auto url = net::ClientUrl::parse("ws://127.0.0.1:" + std::to_string(server().port()));
  const script::ScriptReport report = script::runScript(*script, *url);
  ASSERT_EQ(report.steps.size(), 5u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(report.steps[k].passed) << k << ": " << report.steps[k].detail;
  EXPECT_FALSE(report.steps[4].passed);
  EXPECT_THAT(report.steps[4].detail, HasSubstr("no gauge \"nowhere\""));
}

TEST_F(GaugesOfARoom, HaveNamesAndBoundsInAScript) {
  const auto unnamed = script::parseScript("steps { gauge { min_m: 0 } }", "test");
  ASSERT_FALSE(unnamed);
  EXPECT_THAT(unnamed.error().message, HasSubstr("gauge.gauge is empty"));
  const auto unbound = script::parseScript("steps { gauge { gauge: \"near\" } }", "test");
  ASSERT_FALSE(unbound);
  EXPECT_THAT(unbound.error().message, HasSubstr("gauge needs a bound"));
}

TEST_F(GaugesOfARoom, AreReadByRequestsAndScrapers) {
  ScriptedClient watcher = client();
  watcher.subscribe(v1::LAYER_SURFACE);
  for (int k = 0; k < 60; ++k) ASSERT_TRUE(watcher.nextFrame(v1::LAYER_SURFACE));
  const HttpAnswer list = get("/api/v1/rooms/main/gauges");
  ASSERT_EQ(list.status, 200U) << list.body;
  const boost::json::value listed = boost::json::parse(list.body);
  EXPECT_EQ(listed.at("gauges").as_array().size(), 2u);
  EXPECT_EQ(listed.at("gauges").as_array()[1].at("name").as_string(), "shore");
  const HttpAnswer series = get("/api/v1/rooms/main/gauges/shore");
  ASSERT_EQ(series.status, 200U) << series.body;
  const boost::json::value measured = boost::json::parse(series.body);
  EXPECT_EQ(measured.at("x_m").to_number<double>(), 3.0);
  EXPECT_GT(measured.at("time_s").as_array().size(), 20u);
  EXPECT_EQ(measured.at("time_s").as_array().size(), measured.at("elevation_m").as_array().size());
  EXPECT_EQ(get("/api/v1/rooms/main/gauges/none").status, 404U);
  EXPECT_EQ(get("/api/v1/rooms/plain/gauges").status, 200U);
  EXPECT_EQ(get("/api/v1/rooms/plain/gauges/near").status, 404U);
  EXPECT_THAT(get("/metrics").body, HasSubstr("spindrift_room_gauge_elevation_meters{room=\"main\",gauge=\"shore\"}"));
}

TEST_F(GaugesOfARoom, ReadingsInTheDiagnosticsAreThoseOfTheSeriesAtTheirTime) {
  ScriptedClient player = client();
  player.subscribe(v1::LAYER_DIAGNOSTICS);
  v1::Command wave = splash();
  wave.mutable_splash()->set_x_m(-3);
  ASSERT_TRUE(player.apply(wave));
  const auto newest = player.waitFor([](const v1::ServerMessage& message) {
    return message.has_diagnostics() && message.diagnostics().gauges_time_s() > 0.5;
  });
  ASSERT_TRUE(newest);
  const v1::Diagnostics& now = newest->diagnostics();
  EXPECT_LE(now.gauges_time_s(), now.time_s());
  ASSERT_EQ(now.gauges_size(), 2);
  const boost::json::value series = boost::json::parse(get("/api/v1/rooms/main/gauges/near").body);
  const boost::json::array& times_s = series.at("time_s").as_array();
  const auto at = std::ranges::find_if(
      times_s, [&](const boost::json::value& time) { return time.to_number<double>() == now.gauges_time_s(); });
  ASSERT_NE(at, times_s.end()) << now.gauges_time_s();
  const auto tick = static_cast<std::size_t>(at - times_s.begin());
  EXPECT_NEAR(series.at("elevation_m").as_array()[tick].to_number<double>(), now.gauges(0).elevation_m(), 1e-7);
  EXPECT_NE(now.gauges(0).elevation_m(), 0.0);
}

/// Undoes the differences of v1::Ground, as its comment says.
std::vector<double> riseOf(const v1::Ground& ground) {
  std::vector<std::int64_t> steps;
  for (int i = 0; i < ground.rise_size(); ++i) {
    const auto columns = static_cast<int>(ground.count_x());
    const int before = i % columns != 0 ? i - 1 : i - columns;
    steps.push_back(ground.rise(i) + (before >= 0 ? steps[static_cast<std::size_t>(before)] : 0));
  }
  std::vector<double> out;
  for (const std::int64_t step : steps) out.push_back(static_cast<double>(step) * ground.quantum_m());
  return out;
}

TEST_F(GaugesOfARoom, GroundIsSentAsHeightsOfTheCells) {
  const HttpAnswer answer = get("/api/v1/rooms/main/ground");
  ASSERT_EQ(answer.status, 200U) << answer.body;
  v1::Ground ground;
  ASSERT_TRUE(ground.ParseFromString(answer.body));
  EXPECT_EQ(ground.count_x(), 64u);
  EXPECT_EQ(ground.count_z(), 64u);
  EXPECT_EQ(ground.length_m(), 12.0);
  const std::vector<double> rise_m = riseOf(ground);
  ASSERT_EQ(rise_m.size(), 64u * 64u);
  for (std::size_t i = 0; i < rise_m.size(); ++i) {
    const double x_m = (static_cast<double>(i % 64) + 0.5) * 12 / 64 - 6;
    ASSERT_NEAR(rise_m[i], -1 + 0.25 * std::max(x_m, 0.0), 0.51 * ground.quantum_m()) << i;
  }
  EXPECT_EQ(get("/api/v1/rooms/main/ground").body, answer.body);
  EXPECT_EQ(get("/api/v1/rooms/plain/ground").status, 200U);
  EXPECT_EQ(get("/api/v1/rooms/box/ground").status, 404U) << "a box of particles has none";
}

TEST_F(GaugesOfARoom, GroundFollowsTheParameterOfTheDepth) {
  ScriptedClient operator_client = client();
  ASSERT_EQ(get("/api/v1/rooms/main/ground").status, 200U);
  v1::Command deeper;
  deeper.mutable_set_parameter()->set_path("wave.depth_m");
  deeper.mutable_set_parameter()->set_value(1.5);
  ASSERT_TRUE(operator_client.apply(deeper));
  v1::Ground ground;
  ASSERT_TRUE(ground.ParseFromString(get("/api/v1/rooms/main/ground").body));
  EXPECT_NEAR(riseOf(ground).front(), -1.5, 0.51 * ground.quantum_m());
}

}  // namespace
}  // namespace spindrift::test
