// The REST interface: opening and closing rooms, commands, reading state, and permissions.
#include <atomic>
#include <memory>
#include <thread>

#include <boost/json.hpp>

#include "server_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kRestOperator = "operator-operator-1";
constexpr const char* kRestPlayer = "player-player-player";

struct Answer {
  unsigned status = 0;
  boost::json::value json;  ///< null where the body is not JSON
  std::string body;

  std::string text(const char* member) const {
    const auto* object = json.if_object();
    const auto* found = object ? object->if_contains(member) : nullptr;
    return found && found->is_string() ? std::string(found->as_string()) : "(no " + std::string(member) + ")";
  }
};

class Rest : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kStillPool}}; }
  water::SceneCatalog scenes() const override {
    folder_.write("pond.textproto", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }");
    folder_.write("bay.textproto", std::string(kSleepy));
    folder_.write("broken.textproto", "wave { depth_m: 2000 }");
    return water::SceneCatalog(folder_.path());
  }
  void adjust(service::WaterServerOptions& options) const override { options.max_room_count = 3; }

  Answer ask(const std::string& method, const std::string& path, const std::string& body = "",
             const std::string& token = "") {
    std::string headers = !body.empty()      ? "Content-Type: application/json\r\n"
                          : method == "POST" ? "Content-Length: 0\r\n"
                                             : "";
    if (!token.empty()) headers += "Authorization: Bearer " + token + "\r\n";
    const HttpAnswer answer = httpRequest(server().port(), method, path, headers, body);
    Answer out{answer.status, nullptr, answer.body};
    boost::system::error_code ignored;
    out.json = boost::json::parse(answer.body, ignored);
    return out;
  }

  /// Asks repeatedly, within the rate of an address, until the condition holds; false only after kPatience.
  static bool becomes(const std::function<bool()>& holds) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    return true;
  }

  static constexpr const char* kSleepy = R"(
    unwatched: UNWATCHED_SLEEP
    wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  )";

 private:
  TemporaryFolder folder_;
};

class RestByRole : public Rest {
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(std::string("operator ") + kRestOperator + "\nplayer " + kRestPlayer, "tokens",
                                        core::Role::kViewer);
    ASSERT_TRUE(access);
    options.access.access = *std::move(access);
  }
};

/// Counts how often the server is asked to end; it does not.
class RestOfAProgram : public Rest {
 protected:
  void adjust(service::WaterServerOptions& options) const override {
    options.on_drain = [count = end_count_] { ++*count; };
  }
  const std::shared_ptr<std::atomic<int>> end_count_ = std::make_shared<std::atomic<int>>(0);
};

TEST_F(RestOfAProgram, RepeatedDrainEndsTheServerOnce) {
  EXPECT_EQ(ask("POST", "/api/v1/drain").status, 202U);
  EXPECT_EQ(httpRequest(server().port(), "GET", "/readyz").status, 503U);
  EXPECT_EQ(ask("POST", "/api/v1/drain").status, 202U) << "a client may repeat a request whose answer was lost";
  EXPECT_EQ(*end_count_, 1) << "a second signal would end the wait for the clients";
}

TEST_F(RestOfAProgram, UnexpectedBodyIsRefused) {
  for (const char* const path : {"/api/v1/drain", "/api/v1/rooms/main/snapshot"}) {
    const Answer answer = ask("POST", path, "{}");
    EXPECT_EQ(answer.status, 400U) << path;
    EXPECT_THAT(answer.text("message"), HasSubstr("empty body")) << path;
  }
  EXPECT_EQ(*end_count_, 0);
}

TEST_F(Rest, ASplashIsAppliedAndAnsweredWithItsTick) {
  ScriptedClient watcher = client();
  watcher.subscribe(v1::LAYER_SURFACE);
  const Answer answer = ask("POST", "/api/v1/rooms/main/commands", R"({"command_id": 5, "splash": {"depth_m": 0.4}})");
  EXPECT_EQ(answer.status, 200U) << answer.body;
  const auto& ack = answer.json.at("ack");
  EXPECT_EQ(ack.at("command_id").as_string(), "5");
  EXPECT_FALSE(ack.at("applied_tick").as_string().empty());
  double highest_m = 0.0;
  for (int k = 0; k < 600 && highest_m < 0.05; ++k) {
    const auto frame = watcher.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    highest_m = maxElevation_m(*frame);
  }
  EXPECT_GE(highest_m, 0.05) << "all clients in the room see it";
}

TEST_F(Rest, CommandsAreReadInBothSpellings) {
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", R"({"setPaused": {"paused": true}})").status, 200U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", R"({"set_paused": {"paused": false}})").status, 200U);
}

TEST_F(Rest, BadCommandsAreRejectedWithTheReason) {
  const auto post = [&](const std::string& body) { return ask("POST", "/api/v1/rooms/main/commands", body); };
  for (const char* body : {"splash", "{", "[]", R"({"splosh": {}})", R"({"splash": {"depth_m": "deep"}})"}) {
    const Answer answer = post(body);
    EXPECT_EQ(answer.status, 400U) << body;
    EXPECT_THAT(answer.text("message"), HasSubstr("Command")) << body;
  }
  EXPECT_EQ(post("{}").status, 400U);
  EXPECT_EQ(post("{'reset': {}}").status, 400U);
  EXPECT_EQ(post(R"({"reset": {},})").status, 400U);
  const Answer deep = post(R"({"splash": {"depth_m": 49}})");
  EXPECT_EQ(deep.status, 422U);
  EXPECT_EQ(deep.json.at("reject").at("field").as_string(), "splash.depth_m");
  EXPECT_EQ(post(R"({"splash": {"depth_m": "NaN"}})").status, 422U);
  EXPECT_EQ(post(R"({"change_scene": {"name": "nowhere"}})").status, 404U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/sea/commands", R"({"reset": {}})").status, 404U);
  EXPECT_EQ(ask("GET", "/api/v1/rooms/main/commands").status, 405U);
  EXPECT_EQ(httpRequest(server().port(), "POST", "/api/v1/rooms/main/commands", "Content-Type: text/plain\r\n",
                        R"({"reset": {}})")
                .status,
            415U)
      << "what a foreign page's form can send";
}

TEST_F(Rest, EveryErrorIsAProblemInJson) {
  const auto check = [&](unsigned status, const HttpAnswer& answer) {
    EXPECT_EQ(answer.status, status) << answer.body;
    EXPECT_EQ(answer.headers.at("content-type"), "application/json") << status;
    boost::system::error_code error;
    const auto json = boost::json::parse(answer.body, error);
    ASSERT_FALSE(error) << answer.body;
    EXPECT_TRUE(json.as_object().contains("message")) << answer.body;
  };
  const auto port = server().port();
  const std::string json = "Content-Type: application/json\r\n";
  check(401, httpRequest(port, "GET", "/api/v1/rooms", "Authorization: Bearer wrong-wrong-wrong-1\r\n"));
  EXPECT_EQ(httpRequest(port, "GET", "/api/v1/rooms", "Authorization: Bearer wrong-wrong-wrong-1\r\n")
                .headers.at("www-authenticate"),
            "Bearer");
  check(403, httpRequest(port, "POST", "/api/v1/rooms", json + "Origin: http://evil.example\r\n", "{}"));
  for (const char* path : {"/api/", "/api/v1/", "/api/v1/weather", "/api/v1/rooms/main/weather", "/api/v1/rooms/%ff%22",
                           "/api/v1/rooms/main/scene/x", "/api/v2/rooms"}) {
    check(404, httpRequest(port, "GET", path));
  }
  const HttpAnswer wrong_method = httpRequest(port, "PUT", "/api/v1/rooms", json, "{}");
  check(405, wrong_method);
  EXPECT_EQ(wrong_method.headers.at("allow"), "GET, POST");
  check(411, httpRequest(port, "POST", "/api/v1/rooms/main/commands", json));
  check(413, httpRequest(port, "POST", "/api/v1/rooms", json + "Content-Length: 99999999\r\n"));
  check(415, httpRequest(port, "POST", "/api/v1/rooms", "", "{}"));
  EXPECT_EQ(httpRequest(port, "POST", "/api/v1/rooms/main/commands",
                        "Content-Type: Application/JSON ; charset=utf-8\r\n", R"({"splash": {}})")
                .status,
            200U);
}

TEST_F(Rest, ListsRoomsScenesParametersAndPeople) {
  ScriptedClient ada = person({.name = "Ada"});
  ASSERT_EQ(ada.welcome().person_id(), 1U);
  const Answer room = ask("GET", "/api/v1/rooms/main");
  EXPECT_EQ(room.status, 200U);
  EXPECT_EQ(room.text("name"), "main");
  EXPECT_EQ(room.json.at("session_count").to_number<int>(), 1);
  EXPECT_EQ(room.json.at("people_count").to_number<int>(), 1);
  EXPECT_THAT(ask("GET", "/api/v1/scenes").body, HasSubstr("\"pond\""));
  ASSERT_TRUE(ada.apply(setParameter("wave.depth_m", 1.25)));
  EXPECT_EQ(ask("GET", "/api/v1/rooms/main/scene").json.at("wave").at("depth_m").to_number<double>(), 1.25);
  EXPECT_THAT(ask("GET", "/api/v1/rooms/main/parameters").body, HasSubstr("\"wave.depth_m\""));
  EXPECT_THAT(ask("GET", "/api/v1/rooms/main/people").body, HasSubstr("\"Ada\""));
  EXPECT_EQ(ask("GET", "/api/v1/rooms/main/weather").status, 404U);
}

TEST_F(Rest, RoomsOpenAndClose) {
  const Answer opened = ask("POST", "/api/v1/rooms", R"({"name": "duck", "scene": "pond"})");
  ASSERT_EQ(opened.status, 201U) << opened.body;
  EXPECT_EQ(opened.text("scene"), "pond");
  ScriptedClient one = client("duck");
  EXPECT_EQ(one.greeting().scene().wave().side_m(), 4.0);
  one.subscribe(v1::LAYER_SURFACE);
  EXPECT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(one.apply(splash(0.1, 0.5)));

  EXPECT_EQ(ask("POST", "/api/v1/rooms", R"({"name": "duck", "scene": "pond"})").status, 409U);
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/duck").status, 204U);
  const auto refusal = one.waitFor(v1::ServerMessage::kRefusal);
  ASSERT_TRUE(refusal);
  EXPECT_TRUE(one.ws().waitClosed());
  EXPECT_EQ(one.ws().closeCode(), 4404);
  EXPECT_EQ(ask("GET", "/api/v1/rooms/duck").status, 404U);
  EXPECT_FALSE(ScriptedClient(server().port(), "duck").isOpen());
  EXPECT_EQ(ask("POST", "/api/v1/rooms", R"({"name": "duck", "scene": "pond"})").status, 201U)
      << "the name is free again";
}

TEST_F(Rest, ImpossibleRoomsAreRefusedWithTheReason) {
  const auto post = [&](const std::string& body) { return ask("POST", "/api/v1/rooms", body); };
  EXPECT_EQ(post(R"({"name": "no way", "scene": "pond"})").status, 422U);
  EXPECT_EQ(post(R"({"name": "", "scene": "pond"})").status, 422U);
  EXPECT_EQ(post(R"({"name": "a", "scene": "nowhere"})").status, 404U);
  EXPECT_EQ(post(R"({"name": "a", "scene": "../../etc/passwd"})").status, 404U);
  EXPECT_EQ(post(R"({"name": "a", "colour": "blue"})").status, 400U);
  EXPECT_EQ(post(R"({"name": "a", "scene": "broken"})").status, 500U);
  EXPECT_EQ(post(R"({"name": "a", "scene": "pond"})").status, 201U);
  EXPECT_EQ(post(R"({"name": "b", "scene": "pond"})").status, 201U);
  const Answer full = post(R"({"name": "c", "scene": "pond"})");
  EXPECT_EQ(full.status, 503U);
  EXPECT_THAT(full.text("message"), HasSubstr("--max-rooms"));
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/main").status, 409U) << "the default room stays";
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/zzz").status, 404U);
}

TEST_F(Rest, EmbeddedServerRefusesToDrain) {
  EXPECT_EQ(ask("GET", "/api/v1/drain").status, 405U);
  const Answer answer = ask("POST", "/api/v1/drain");
  EXPECT_EQ(answer.status, 409U);
  EXPECT_THAT(answer.text("message"), HasSubstr("part of another program"));
  EXPECT_EQ(httpRequest(server().port(), "GET", "/readyz").status, 200U);
}

TEST_F(Rest, DrainingServerOpensNoRooms) {
  server().drain(std::chrono::seconds(2), "");
  const HttpAnswer ready = httpRequest(server().port(), "GET", "/readyz");
  EXPECT_EQ(ready.status, 503U);
  EXPECT_EQ(ready.body, "draining\n");
  EXPECT_EQ(httpRequest(server().port(), "GET", "/healthz").status, 200U);
  const HttpAnswer room = httpRequest(server().port(), "POST", "/api/v1/rooms", "Content-Type: application/json\r\n",
                                      R"({"name": "late", "scene": "pond"})");
  EXPECT_EQ(room.status, 503U);
  EXPECT_EQ(room.headers.at("retry-after"), "5");
  EXPECT_EQ(ask("GET", "/api/v1/rooms").status, 200U);
}

TEST_F(RestByRole, RequestsThatChangeSomethingNeedAToken) {
  const std::string splash = R"({"splash": {"depth_m": 0.3}})";
  const std::string reset = R"({"reset": {}})";
  const std::string room = R"({"name": "duck", "scene": "pond"})";
  EXPECT_EQ(ask("GET", "/api/v1/rooms").status, 200U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", splash).status, 403U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", splash, kRestPlayer).status, 200U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", reset, kRestPlayer).status, 403U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", reset, kRestOperator).status, 200U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms", room, kRestPlayer).status, 403U);
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/main", "", kRestPlayer).status, 403U);
  EXPECT_EQ(ask("POST", "/api/v1/drain", "", kRestPlayer).status, 403U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms", room, kRestOperator).status, 201U);
  const Answer wrong = ask("GET", "/api/v1/rooms", "", "wrong-wrong-wrong-1");
  EXPECT_EQ(wrong.status, 401U);
  EXPECT_THAT(wrong.body, Not(HasSubstr("wrong-wrong")));
}

TEST_F(Rest, UnwatchedRoomSleepsUntilSomebodyNeedsIt) {
  ASSERT_EQ(ask("POST", "/api/v1/rooms", R"({"name": "bay", "scene": "bay"})").status, 201U);
  const auto isAsleep = [&] { return ask("GET", "/api/v1/rooms/bay").json.at("asleep").as_bool(); };
  const auto tickOf = [&](const char* room) {
    return std::stoull(ask("GET", std::string("/api/v1/rooms/") + room).text("tick"));
  };
  const auto expectWoken = [&](const std::function<void()>& by) {
    ASSERT_TRUE(becomes(isAsleep)) << "lists of the rooms, and of what a room is, do not keep it awake";
    const auto asleep_tick = tickOf("bay");
    const auto main_tick = tickOf("main");
    EXPECT_TRUE(becomes([&] { return tickOf("main") > main_tick; })) << "the others continue";
    EXPECT_EQ(tickOf("bay"), asleep_tick);
    by();
    EXPECT_TRUE(becomes([&] { return tickOf("bay") > asleep_tick; }));
  };
  expectWoken(
      [&] { EXPECT_EQ(ask("POST", "/api/v1/rooms/bay/commands", R"({"splash": {"depth_m": 0.2}})").status, 200U); });
  expectWoken([&] { EXPECT_EQ(ask("GET", "/api/v1/rooms/bay/gauges").status, 200U); });
  ASSERT_TRUE(becomes(isAsleep));

  ScriptedClient visitor = client("bay");
  visitor.subscribe(v1::LAYER_SURFACE);
  const auto frame = visitor.nextFrame(v1::LAYER_SURFACE);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(visitor.runFor(3)) << "awake";
  EXPECT_TRUE(becomes([&] { return !isAsleep(); }));
}

TEST_F(Rest, MetricsCountSessionsCommandsFramesAndRefusals) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  ASSERT_TRUE(one.apply(splash()));
  EXPECT_EQ(one.rejected(splash(49)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  (void)httpRequest(server().port(), "POST", "/api/v1/rooms", "Origin: http://evil.example\r\n", "{}");
  const HttpAnswer answer = httpRequest(server().port(), "GET", "/metrics");
  EXPECT_EQ(answer.status, 200U);
  EXPECT_THAT(answer.headers.at("content-type"), HasSubstr("version=0.0.4"));
  for (const char* line :
       {"spindrift_room_ticks_total{room=\"main\"} ", "spindrift_room_real_time_factor{room=\"main\"} ",
        "spindrift_room_sessions{room=\"main\"} 1\n", "spindrift_sessions 1\n",
        "spindrift_room_particles{room=\"main\"} ", "spindrift_room_device_bytes{room=\"main\"} ",
        "spindrift_commands_applied_total 1\n", "spindrift_commands_rejected_total{reason=\"out_of_range\"} 1\n",
        "spindrift_refused_total{reason=\"origin\"} 1\n",
        "spindrift_encoded_frames_total{layer=\"surface\",packing=\"plain\",level=\"full\"} ",
        "spindrift_encode_seconds_total{layer=\"surface\",packing=\"packed\",level=\"full\"} 0\n",
        "spindrift_room_speed{room=\"main\"} 1\n", "spindrift_room_lost{room=\"main\"} 0\n",
        "spindrift_room_volume_error_units{room=\"main\"} 0\n", "spindrift_room_nonfinite_total{room=\"main\"} 0\n",
        "spindrift_room_pass_seconds{room=\"main\",pass=\"", "spindrift_room_command_queue{room=\"main\"} ",
        "spindrift_control_queue 0\n", "# TYPE spindrift_sent_bytes_total counter\n"}) {
    EXPECT_THAT(answer.body, HasSubstr(line));
  }
  EXPECT_EQ(ask("POST", "/metrics", "{}").status, 405U);
}

}  // namespace
}  // namespace spindrift::test
