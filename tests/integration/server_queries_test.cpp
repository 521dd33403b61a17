// What the water says at points, over real connections and by requests: agreement with the picture, ticks, roles,
// bounds.
#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/v1/api.pb.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kAskedPool = R"(
  wave { resolution_count: 64 side_m: 12 depth_m: 1 }
  stream { frame_rate_hz: 60 }
)";
constexpr const char* kQueryOperator = "operator-operator-1";
constexpr const char* kQueryViewer = "viewer-viewer-viewer-1";

/// Guests are players, and are gone a moment after their connection.
class Queries : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kAskedPool}, {"box", "particles {}"}}; }
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(fmt::format("operator {}\nviewer {}\n", kQueryOperator, kQueryViewer), "tokens",
                                        core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
    options.rules.grace = std::chrono::milliseconds(50);
  }
  HttpAnswer get(const std::string& query, const std::string& room = "main") {
    return httpRequest(server().port(), "GET", "/api/v1/rooms/" + room + "/surface" + query, "", "");
  }
  HttpAnswer post(const std::string& body) {
    return httpRequest(server().port(), "POST", "/api/v1/rooms/main/surface", "Content-Type: application/json\r\n",
                       body);
  }
};

v1::Command queryAt(const std::vector<std::pair<double, double>>& points, std::uint32_t query_id = 0,
                    std::uint32_t interval_ticks = 0) {
  v1::Command command;
  v1::Query& query = *command.mutable_query();
  query.set_query_id(query_id);
  query.set_interval_ticks(interval_ticks);
  for (const auto& [x_m, z_m] : points) {
    query.add_x_m(static_cast<float>(x_m));
    query.add_z_m(static_cast<float>(z_m));
  }
  return command;
}

v1::QueryAnswer nextAnswer(ScriptedClient& client) {
  const auto message = client.waitFor([](const v1::ServerMessage& one) { return one.has_query_answer(); });
  if (!message) ADD_FAILURE() << "no answer came";
  return message ? message->query_answer() : v1::QueryAnswer();
}

const v1::QueryResult* resultOf(const v1::QueryAnswer& answer, std::uint32_t query_id) {
  const auto found = std::ranges::find(answer.results(), query_id, &v1::QueryResult::query_id);
  return found != answer.results().end() ? &*found : nullptr;
}

TEST_F(Queries, AckAnswerAndPictureOfATickShowTheSameWater) {
  ScriptedClient chief = person({.token = kQueryOperator});
  EXPECT_GE(chief.greeting().version().minor(), 10u);
  ASSERT_TRUE(chief.apply(splash()));
  ASSERT_TRUE(chief.runFor(40));
  ASSERT_TRUE(chief.apply(setPaused(true)));
  const std::vector<std::pair<double, double>> points = {{0.3, -0.2}, {-4.1, 2.2}, {5.9, 5.95}, {2.0, -3.3}};
  const v1::ServerMessage ack = chief.ask(queryAt(points, 5));
  ASSERT_TRUE(ack.has_ack()) << ack.reject().message();
  const v1::QueryAnswer answer = nextAnswer(chief);
  EXPECT_EQ(answer.tick(), ack.ack().applied_tick());
  ASSERT_EQ(answer.results_size(), 1);
  const v1::QueryResult& result = answer.results(0);
  EXPECT_EQ(result.query_id(), 5u);
  EXPECT_TRUE(result.last());
  EXPECT_THAT(result.ended(), IsEmpty());
  EXPECT_THAT(result.outside(), IsEmpty());
  chief.subscribe(v1::LAYER_SURFACE);
  const auto frame = chief.waitFor([&](const v1::ServerMessage& one) {
    return one.has_frame() && one.frame().has_surface_fixed16() && one.frame().tick() == answer.tick();
  });
  ASSERT_TRUE(frame) << "no frame of tick " << answer.tick();
  EXPECT_EQ(frame->frame().state_id(), answer.state_id());
  EXPECT_EQ(frame->frame().time_s(), answer.time_s());
  const v1::SurfaceFixed16& surface = frame->frame().surface_fixed16();
  const auto n = static_cast<int>(surface.resolution_count());
  const auto height_m = [&](double column, double row) {
    const auto i = static_cast<std::size_t>(std::clamp(static_cast<int>(column), 0, n - 1));
    const auto k = static_cast<std::size_t>(std::clamp(static_cast<int>(row), 0, n - 1));
    const std::string& bytes = frame->frame().payload();
    const std::size_t at = 2 * (i + static_cast<std::size_t>(n) * k);
    const unsigned word = static_cast<unsigned char>(bytes[at]) | static_cast<unsigned char>(bytes[at + 1]) << 8u;
    return static_cast<std::int16_t>(word) * surface.quantum_m();
  };
  double highest_m = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double column = (points[p].first / 12 + 0.5) * n - 0.5, row = (points[p].second / 12 + 0.5) * n - 0.5;
    const double i = std::floor(column), k = std::floor(row), u = column - i, v = row - k;
    const double expected_m = (1 - v) * ((1 - u) * height_m(i, k) + u * height_m(i + 1, k)) +
                              v * ((1 - u) * height_m(i, k + 1) + u * height_m(i + 1, k + 1));
    EXPECT_NEAR(result.elevation_m(static_cast<int>(p)), expected_m, surface.quantum_m()) << p;
    highest_m = std::max(highest_m, std::abs(expected_m));
  }
  EXPECT_GT(highest_m, 5 * surface.quantum_m()) << "the water moves";
}

TEST_F(Queries, AStreamHasOneAnswerPerTickUntilItIsEnded) {
  ScriptedClient watcher = person({.token = kQueryViewer});
  v1::Command moving = queryAt({{0, 0}, {1, 1}}, 1, 1);
  moving.mutable_query()->add_velocity_x_mps(600.0F);  // outside after a tick
  const v1::ServerMessage ack = watcher.ask(queryAt({{2, 2}}, 2, 3));
  ASSERT_TRUE(ack.has_ack()) << ack.reject().message();
  ASSERT_TRUE(watcher.ask(moving).has_ack());
  std::uint64_t last_tick = 0, last_third = 0;
  int of_both_count = 0;
  for (int k = 0; k < 30; ++k) {
    const v1::QueryAnswer answer = nextAnswer(watcher);
    EXPECT_GT(answer.tick(), last_tick);
    last_tick = answer.tick();
    if (const v1::QueryResult* every = resultOf(answer, 1)) {
      EXPECT_FALSE(every->last());
      ASSERT_EQ(every->elevation_m_size(), 2);
      if (k > 10) {
        EXPECT_THAT(every->outside(), ElementsAre(0u, 1u)) << "they move";
      }
    }
    if (const v1::QueryResult* third = resultOf(answer, 2)) {
      EXPECT_THAT(third->outside(), IsEmpty());
      if (last_third > 0) {
        EXPECT_EQ((answer.tick() - last_third) % 3, 0u);
      }
      last_third = answer.tick();
      of_both_count += resultOf(answer, 1) ? 1 : 0;
    }
  }
  EXPECT_GT(of_both_count, 3) << "one message for both";
  ASSERT_TRUE(watcher.ask(queryAt({}, 1)).has_ack());
  const v1::ServerMessage ended = watcher.ask(queryAt({}, 2));
  ASSERT_TRUE(ended.has_ack());
  for (std::uint64_t tick = 0; tick < ended.ack().applied_tick() + 10;) {
    tick = watcher.ask(queryAt({{0, 0}}, 9)).ack().applied_tick();
    ASSERT_GT(tick, 0u);
    for (v1::QueryAnswer answer = nextAnswer(watcher); !resultOf(answer, 9); answer = nextAnswer(watcher)) {
      ASSERT_LE(answer.tick(), ended.ack().applied_tick());
      ASSERT_GT(answer.results_size(), 0);
    }
  }
}

TEST_F(Queries, OfARequestAreAnsweredAtOnce) {
  ScriptedClient chief = person({.token = kQueryOperator});
  ASSERT_TRUE(chief.apply(splash()));
  ASSERT_TRUE(chief.runFor(20));
  ASSERT_TRUE(chief.apply(setPaused(true)));
  const HttpAnswer one = get("?x=0.5&z=-0.25");
  ASSERT_EQ(one.status, 200U) << one.body;
  const boost::json::value point = boost::json::parse(one.body);
  const HttpAnswer many = post(R"({"query_id": 3, "x_m": [0.5, 700], "z_m": [-0.25, 0]})");
  ASSERT_EQ(many.status, 200U) << many.body;
  const boost::json::value answer = boost::json::parse(many.body);
  const boost::json::value& result = answer.at("results").at(0);
  EXPECT_EQ(answer.at("tick"), point.at("tick"));
  EXPECT_EQ(result.at("query_id").to_number<int>(), 3);
  for (const char* name : {"elevation_m", "vertical_speed_mps", "velocity_x_mps", "velocity_z_mps", "slope_x",
                           "slope_z", "depth_m", "wet_ratio", "foam_ratio"}) {
    EXPECT_EQ(result.at(name).at(0), point.at(name)) << name;
    EXPECT_EQ(result.at(name).at(1).to_number<double>(), 0.0) << name;
  }
  EXPECT_NE(point.at("elevation_m").to_number<double>(), 0.0);
  EXPECT_FALSE(point.at("outside").as_bool());
  EXPECT_THAT(result.at("outside").as_array(), ElementsAre(boost::json::value(1)));
}

TEST_F(Queries, ThatAreFaultyAreRefusedWithFieldValueAndBound) {
  ScriptedClient ada = client();
  const v1::Reject nan = ada.rejected(queryAt({{0, 0}, {0, std::nan("")}}));
  EXPECT_EQ(nan.reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(nan.field(), "query.z_m[1]");
  EXPECT_THAT(nan.message(), HasSubstr("nan is not a finite number"));
  EXPECT_EQ(ada.rejected(queryAt({{std::numeric_limits<float>::infinity(), 0}})).field(), "query.x_m[0]");
  const v1::Reject many = ada.rejected(queryAt(std::vector<std::pair<double, double>>(1025)));
  EXPECT_EQ(many.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_THAT(many.message(), HasSubstr("1025 points are more than 1024"));
  v1::Command uneven = queryAt({{0, 0}, {1, 1}});
  uneven.mutable_query()->add_z_m(3);
  EXPECT_THAT(ada.rejected(uneven).message(), HasSubstr("3 values for 2 of x_m"));
  v1::Command velocities = queryAt({{0, 0}, {1, 1}, {2, 2}}, 1, 1);
  for (int k = 0; k < 2; ++k) velocities.mutable_query()->add_velocity_z_mps(1);
  EXPECT_EQ(ada.rejected(velocities).field(), "query.velocity_z_mps");
  EXPECT_EQ(ada.rejected(queryAt({{0, 0}}, 1, 3601)).field(), "query.interval_ticks");
  ScriptedClient bob = client("box");
  const v1::Reject dry = bob.rejected(queryAt({{0, 0}}));
  EXPECT_EQ(dry.reason(), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_THAT(dry.message(), HasSubstr("no wave"));

  EXPECT_EQ(get("?x=0&z=0", "box").status, 422U);
  EXPECT_EQ(get("?x=0&z=0", "nowhere").status, 404U);
  for (const auto& [query, text] :
       {std::pair("?x=nan&z=0", "x: nan is not a finite number"), std::pair("?x=1&z=one", "z: 'one' is not a number"),
        std::pair("?x=1", "z: 0 values"), std::pair("?x=1&z=1e39", "z: 1e+39 is not"),
        std::pair("?x=1&z=2&y=3", "'y' is not a parameter of this address")}) {
    const HttpAnswer refused = get(query);
    EXPECT_EQ(refused.status, 400U) << query;
    EXPECT_THAT(refused.body, HasSubstr(text)) << query;
  }
  for (const auto& [body, text] :
       {std::pair(R"({"x_m": [1], "z_m": [1], "y_m": [1]})", "y_m: Query has no such field"),
        std::pair(R"({"x_m": ["NaN"], "z_m": [1]})", "nan is not a finite number"),
        std::pair("{}", "there are no points"), std::pair(R"({"x_m": [1], "z_m": []})", "0 values for 1 of x_m"),
        std::pair(R"({"x_m": [1], "z_m": [1], "interval_ticks": 1})", "a request is answered once")}) {
    const HttpAnswer refused = post(body);
    EXPECT_THAT(refused.status, testing::AnyOf(400U, 422U)) << body;
    EXPECT_THAT(refused.body, HasSubstr(text)) << body;
  }
  const HttpAnswer elsewhere = httpRequest(server().port(), "POST", "/api/v1/rooms/main/commands",
                                           "Content-Type: application/json\r\n", R"({"query": {}})");
  EXPECT_EQ(elsewhere.status, 400U);
  EXPECT_THAT(elsewhere.body, HasSubstr("/surface"));
}

TEST_F(Queries, OfStreamsAreBoundedPerSessionAndEndWithIt) {
  const std::vector<std::pair<double, double>> full(1024), half(512);
  ScriptedClient ada = client();
  ASSERT_TRUE(ada.ask(queryAt(half, 1, 60)).has_ack());
  ASSERT_TRUE(ada.ask(queryAt(half, 2, 60)).has_ack());
  const v1::Reject more = ada.rejected(queryAt({{0, 0}}, 3, 60));
  EXPECT_EQ(more.reason(), v1::REJECT_REASON_BUSY);
  EXPECT_THAT(more.message(), HasSubstr("you would have 1025 points that wait or stream, 1024 are the most"));
  EXPECT_TRUE(ada.ask(queryAt(half, 2, 60)).has_ack()) << "it takes the place of the one before";
  std::vector<ScriptedClient> others;
  for (int k = 0; k < 7; ++k) {
    others.push_back(client());
    ASSERT_TRUE(others.back().ask(queryAt(full, 1, 60)).has_ack()) << k;
  }
  const HttpAnswer busy = get("?x=0&z=0");
  EXPECT_EQ(busy.status, 503U);
  EXPECT_THAT(busy.body, HasSubstr("the room would have 8193 points that wait or stream, 8192 are the most"));
  others.back().ws().vanish();
  others.pop_back();
  unsigned status = 503;
  for (int k = 0; k < 500 && status == 503; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = get("?x=0&z=0").status;
  }
  EXPECT_EQ(status, 200U) << "the points of who has left are free";
}

TEST_F(Queries, NeedNoRightToCommandAndChangeNothing) {
  ScriptedClient ada = client();
  ScriptedClient chief = person({.token = kQueryOperator});
  v1::Command lesson;
  lesson.mutable_set_lesson()->mutable_lesson()->set_frozen(true);
  ASSERT_TRUE(chief.apply(lesson));
  EXPECT_TRUE(ada.ask(queryAt({{0, 0}})).has_ack()) << "also while the room takes no commands of players";
  EXPECT_THAT(get("?x=0&z=0").body, HasSubstr("\"elevation_m\":0,"));
}

}  // namespace
}  // namespace spindrift::test
