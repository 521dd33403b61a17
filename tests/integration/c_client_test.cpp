// The C library with the real program: what it says is what the server says, and it keeps its connection by itself.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <thread>

#include <boost/json.hpp>
#include <spindrift_client.h>

#include "program_fixture.h"

namespace spindrift::test {
namespace {

using testing::AllOf;
using testing::Gt;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kPool = R"(
  wave { resolution_count: 64 side_m: 16 depth_m: 1 damping_per_s: 0.1 boundary_minus_x: WAVE_BOUNDARY_ABSORB
    boundary_plus_x: WAVE_BOUNDARY_ABSORB boundary_minus_z: WAVE_BOUNDARY_REFLECT boundary_plus_z: WAVE_BOUNDARY_REFLECT }
  events {
    every_s: 1.8
    effect { breaking_wave { side: SIDE_MINUS_X shape: WAVE_SHAPE_SWELL amplitude_m: 0.2 length_m: 5 duration_s: 1 } }
  }
)";

class CClient : public ProgramTest {
 protected:
  /// A server whose rasteriser computes on the thread that asks.
  struct Server {
    std::unique_ptr<ChildProcess> process;
    std::uint16_t port = 0;
    [[nodiscard]] std::string url() const { return "http://127.0.0.1:" + std::to_string(port); }
  };
  Server serve(std::uint16_t port = 0, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "serve",  "--device",           "software", "--scene", scene(kPool, "pool.textproto"),
        "--port", std::to_string(port), "--grace",  "300"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Server out;
    out.process =
        std::make_unique<ChildProcess>(SPINDRIFT_PROGRAM, arguments, std::vector<std::string>{"LP_NUM_THREADS=0"});
    const std::string mark = "Spindrift is ready: http://127.0.0.1:";
    const auto line = out.process->waitForLine(mark);
    if (!line) throw std::runtime_error(out.process->err());
    out.port = static_cast<std::uint16_t>(std::stoi(line->substr(mark.size())));
    return out;
  }
  static boost::json::object post(const Server& server, const std::string& path, const std::string& body) {
    const HttpAnswer answer =
        httpRequest(server.port, "POST", "/api/v1/rooms/main/" + path, "Content-Type: application/json\r\n", body);
    EXPECT_EQ(answer.status, 200u) << answer.body;
    return answer.status == 200 ? boost::json::parse(answer.body).as_object() : boost::json::object();
  }
  static void pause(const Server& server, bool paused) {
    post(server, "commands", paused ? R"({"setPaused": {"paused": true}})" : R"({"setPaused": {}})");
  }

  struct Leave {
    void operator()(spindrift_room* room) const { spindrift_disconnect(room); }
  };
  using Room = std::unique_ptr<spindrift_room, Leave>;
  /// Null and a failure of the test if it does not connect.
  static Room connect(const std::string& url) {
    spindrift_options options = {};
    options.url = url.c_str();
    options.name = "C";
    options.answer_within_s = 30.0;
    spindrift_room* room = nullptr;
    EXPECT_EQ(spindrift_connect(&options, 30.0, &room), SPINDRIFT_OK) << spindrift_error();
    return Room(room);
  }
};

double numberOf(const boost::json::object& object, const char* list, std::size_t k) {
  return object.at("results").as_array().at(0).at(list).as_array().at(k).to_number<double>();
}

std::uint64_t tickOf(const boost::json::object& answer) {
  const boost::json::value& tick = answer.at("tick");
  return tick.is_string() ? std::stoull(std::string(tick.as_string())) : tick.to_number<std::uint64_t>();
}

TEST_F(CClient, QueryAgreesWithRestAtTheSameTick) {
  const Server server = serve();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  spindrift_moment moment = {};
  spindrift_sample samples[3] = {};
  const float x_m[] = {0.3f, -4.1f, 900.0f}, z_m[] = {-0.2f, 2.2f, 0.0f};
  do {  // until the first wave is there
    ASSERT_EQ(spindrift_query(room.get(), x_m, z_m, 3, &moment, samples), SPINDRIFT_OK) << spindrift_error();
  } while (std::abs(samples[0].elevation_m) < 0.005f);
  pause(server, true);
  ASSERT_EQ(spindrift_query(room.get(), x_m, z_m, 3, &moment, samples), SPINDRIFT_OK) << spindrift_error();
  const auto rest = post(server, "surface", R"({"x_m": [0.3, -4.1, 900], "z_m": [-0.2, 2.2, 0]})");
  EXPECT_EQ(moment.tick, tickOf(rest));
  EXPECT_NEAR(moment.time_s, rest.at("time_s").to_number<double>(), 1e-9);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(samples[k].elevation_m, numberOf(rest, "elevation_m", k), 1e-6);
    EXPECT_NEAR(samples[k].vertical_speed_mps, numberOf(rest, "vertical_speed_mps", k), 1e-6);
    EXPECT_NEAR(samples[k].velocity_x_mps, numberOf(rest, "velocity_x_mps", k), 1e-6);
    EXPECT_NEAR(samples[k].slope_x, numberOf(rest, "slope_x", k), 1e-6);
    EXPECT_NEAR(samples[k].depth_m, 1.0 + samples[k].elevation_m, 1e-4);
    EXPECT_EQ(samples[k].outside, 0);
  }
  EXPECT_EQ(samples[2].outside, 1);
  EXPECT_EQ(samples[2].elevation_m, 0.0f);
}

TEST_F(CClient, BoxRidesTheWavesAndItsWaterAgreesWithRest) {
  const Server server = serve();
  ChildProcess box(SPINDRIFT_FLOATING_BOX, {server.url(), "-2", "1"});
  ASSERT_TRUE(box.waitForLine("the box starts")) << box.err();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  spindrift_moment moment = {};
  spindrift_sample sample = {};
  const float x_m = -2.0f, z_m = 1.0f;
  do {
    ASSERT_EQ(spindrift_query(room.get(), &x_m, &z_m, 1, &moment, &sample), SPINDRIFT_OK) << spindrift_error();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  } while (moment.time_s < 9.0);
  pause(server, true);
  ASSERT_EQ(box.wait(), 0) << box.err();
  double waves_m = 0.0, off_m = 0.0, ticks_count = 0.0;
  unsigned long long tick = 0;
  double time_s = 0.0, elevation_m = 0.0, vx_mps = 0.0, vy_mps = 0.0, vz_mps = 0.0;
  const std::string summary = box.out().substr(box.out().find("waves of"));
  ASSERT_EQ(std::sscanf(summary.c_str(), "waves of %lf m, the box was off by %lf m (root mean squares of %lf", &waves_m,
                        &off_m, &ticks_count),
            3)
      << summary;
  EXPECT_GT(waves_m, 0.01);
  EXPECT_LT(off_m, 0.35 * waves_m);
  EXPECT_GT(ticks_count, 60);
  const std::string last = summary.substr(summary.find("tick "));
  ASSERT_EQ(std::sscanf(last.substr(last.rfind("tick ")).c_str(),
                        "tick %llu time_s %lf elevation_m %lf velocity_mps %lf %lf %lf", &tick, &time_s, &elevation_m,
                        &vx_mps, &vy_mps, &vz_mps),
            6)
      << last;
  const auto rest = post(server, "surface", R"({"x_m": [-2], "z_m": [1]})");
  EXPECT_EQ(tick, tickOf(rest));
  EXPECT_NEAR(elevation_m, numberOf(rest, "elevation_m", 0), 1e-5);
  EXPECT_NEAR(vx_mps, numberOf(rest, "velocity_x_mps", 0), 1e-5);
  EXPECT_NEAR(vy_mps, numberOf(rest, "vertical_speed_mps", 0), 1e-5);
  EXPECT_NEAR(vz_mps, numberOf(rest, "velocity_z_mps", 0), 1e-5);
}

TEST_F(CClient, ProgramInCIsThatOfTheDocumentationAndRuns) {
  const auto read = [](const std::string& file) {
    std::ifstream stream(SPINDRIFT_SOURCE_DIR "/" + file);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::string code = read("server/client/example/points.c");
  ASSERT_THAT(code, HasSubstr("spindrift_follow"));
  EXPECT_THAT(read("docs/c.md"), HasSubstr("```c\n" + code + "```\n"));
  const Server server = serve();
  const Outcome outcome = runProgram({server.url()}, {}, SPINDRIFT_POINTS);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(lineCount(outcome.out), 3) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr(" s: "));
  const Outcome nobody = runProgram({"http://127.0.0.1:1"}, {}, SPINDRIFT_POINTS);
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_THAT(nobody.err, AllOf(HasSubstr("no connection to 127.0.0.1:1/ws"), HasSubstr("refused")));
}

TEST_F(CClient, FollowedPointsComeAgainAfterTheServerWasKilled) {
  Server server = serve();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  const float x_m[] = {0.5f, 1.0f}, z_m[] = {0.0f, 0.0f};
  spindrift_moment moment = {};
  spindrift_sample samples[2] = {};
  ASSERT_EQ(spindrift_follow(room.get(), x_m, z_m, 2, 1), SPINDRIFT_OK) << spindrift_error();
  for (std::uint64_t before = 0; before < 3; before = moment.number) {
    ASSERT_EQ(spindrift_newest(room.get(), before, 30.0, &moment, samples, 2), SPINDRIFT_OK) << spindrift_error();
    EXPECT_GT(moment.number, before);
  }
  server.process->signal(SIGKILL);
  (void)server.process->wait();
  while (spindrift_state(room.get()) == SPINDRIFT_OK) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(spindrift_newest(room.get(), 0, 0.0, &moment, samples, 2), SPINDRIFT_NOT_CONNECTED)
      << "and the last answer";
  EXPECT_THAT(samples[0].depth_m, Gt(0.5f));
  EXPECT_EQ(spindrift_query(room.get(), x_m, z_m, 2, &moment, samples), SPINDRIFT_NOT_CONNECTED);
  EXPECT_THAT(spindrift_error(), HasSubstr("was not sent"));
  const std::uint16_t port = server.port;
  server = serve(port);
  const std::uint64_t last = moment.number;
  spindrift_status status = SPINDRIFT_NOT_CONNECTED;
  for (int attempt = 0; attempt < 60 && status != SPINDRIFT_OK; ++attempt) {
    status = spindrift_newest(room.get(), last, 1.0, &moment, samples, 2);
  }
  ASSERT_EQ(status, SPINDRIFT_OK) << spindrift_error();
  EXPECT_EQ(spindrift_connection_count(room.get()), 2u);
  EXPECT_EQ(spindrift_state(room.get()), SPINDRIFT_OK);
}

TEST_F(CClient, FollowsADrainingServerToAnotherOne) {
  const Server other = serve();
  const Server first = serve(0, {"--drain-s", "3", "--drain-to", "ws://127.0.0.1:" + std::to_string(other.port)});
  const Room room = connect(first.url());
  ASSERT_TRUE(room);
  const float x_m = 0.5f, z_m = 0.0f;
  spindrift_moment moment = {};
  spindrift_sample sample = {};
  ASSERT_EQ(spindrift_follow(room.get(), &x_m, &z_m, 1, 1), SPINDRIFT_OK) << spindrift_error();
  first.process->signal(SIGTERM);
  EXPECT_EQ(first.process->wait(), 0);
  spindrift_status status = SPINDRIFT_NOT_CONNECTED;
  for (int attempt = 0; attempt < 60 && (status != SPINDRIFT_OK || spindrift_connection_count(room.get()) < 2);
       ++attempt)
    status = spindrift_newest(room.get(), moment.number, 1.0, &moment, &sample, 1);
  EXPECT_EQ(status, SPINDRIFT_OK) << spindrift_error();
  EXPECT_THAT(httpRequest(other.port, "GET", "/api/v1/rooms/main/people").body, HasSubstr("\"C\""));
}

TEST_F(CClient, FollowedPointsCanBeReplacedAndContinueInAnotherScene) {
  const Server server = serve();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  std::vector<float> x_m(SPINDRIFT_MAX_POINTS, 0.25f), z_m(SPINDRIFT_MAX_POINTS, 1.0f);
  std::vector<spindrift_sample> samples(SPINDRIFT_MAX_POINTS);
  spindrift_moment moment = {};
  const auto newest = [&](std::size_t count) {
    return spindrift_newest(room.get(), 0, 30.0, &moment, samples.data(), count);
  };
  EXPECT_EQ(newest(1), SPINDRIFT_BAD_ARGUMENT);
  EXPECT_THAT(spindrift_error(), HasSubstr("spindrift_follow"));
  // All points that a client may ask for, twice.
  for (int k = 0; k < 2; ++k) {
    x_m[7] = static_cast<float>(600 * k);
    ASSERT_EQ(spindrift_follow(room.get(), x_m.data(), z_m.data(), x_m.size(), 1), SPINDRIFT_OK) << spindrift_error();
    ASSERT_EQ(newest(x_m.size()), SPINDRIFT_OK) << spindrift_error();
    EXPECT_EQ(samples[7].outside, k);
  }
  EXPECT_EQ(newest(3), SPINDRIFT_BAD_ARGUMENT);
  EXPECT_THAT(spindrift_error(), HasSubstr("count 3: 1024 points are followed"));
  ASSERT_EQ(spindrift_follow(room.get(), x_m.data(), z_m.data(), 1, 1), SPINDRIFT_OK) << spindrift_error();
  ASSERT_EQ(newest(1), SPINDRIFT_OK) << spindrift_error();
  const float depth_m = samples[0].depth_m;
  post(server, "commands", R"({"changeScene": {"name": "wave_only"}})");
  const auto is_other = [&] { return std::abs(samples[0].depth_m - depth_m) > 0.2f; };
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!is_other() && std::chrono::steady_clock::now() < deadline)
    (void)spindrift_newest(room.get(), moment.number, 1.0, &moment, samples.data(), 1);
  EXPECT_TRUE(is_other()) << samples[0].depth_m;
  ASSERT_EQ(spindrift_follow(room.get(), nullptr, nullptr, 0, 1), SPINDRIFT_OK) << spindrift_error();
  EXPECT_EQ(newest(1), SPINDRIFT_BAD_ARGUMENT);
}

TEST_F(CClient, HeldClockMakesExactlyTheTicksThatAreAskedFor) {
  const Server server = serve();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  const float x_m = 0.5f, z_m = 0.0f;
  spindrift_moment moment = {};
  spindrift_sample sample = {};
  ASSERT_EQ(spindrift_take_clock(room.get(), 0.0, 30.0), SPINDRIFT_OK) << spindrift_error();
  ASSERT_EQ(spindrift_follow(room.get(), &x_m, &z_m, 1, 1), SPINDRIFT_OK) << spindrift_error();
  std::uint64_t tick = 0, state_hash = 0;
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(spindrift_step(room.get(), 6, &tick, &state_hash), SPINDRIFT_OK) << spindrift_error();
    while (moment.tick < tick) {
      ASSERT_EQ(spindrift_newest(room.get(), moment.number, 30.0, &moment, &sample, 1), SPINDRIFT_OK)
          << spindrift_error();
    }
    EXPECT_EQ(moment.tick, tick);
  }
  EXPECT_EQ(spindrift_newest(room.get(), moment.number, 0.3, &moment, &sample, 1), SPINDRIFT_NO_ANSWER);
  const auto rest =
      boost::json::parse(httpRequest(server.port, "GET", "/api/v1/rooms/main/state_hash").body).as_object();
  EXPECT_EQ(tickOf(rest), tick);
  EXPECT_EQ(std::string(rest.at("state_hash").as_string()), std::to_string(state_hash));
  EXPECT_EQ(spindrift_take_clock(room.get(), -1.0, 30.0), SPINDRIFT_REJECTED);
  EXPECT_THAT(spindrift_error(), HasSubstr("take_clock.speed"));
  ASSERT_EQ(spindrift_release_clock(room.get()), SPINDRIFT_OK) << spindrift_error();
  EXPECT_EQ(spindrift_newest(room.get(), moment.number, 30.0, &moment, &sample, 1), SPINDRIFT_OK) << "it runs again";
  EXPECT_EQ(spindrift_step(room.get(), 1, nullptr, nullptr), SPINDRIFT_REJECTED);
}

TEST_F(CClient, FaultsSayWhatIsWrong) {
  const Server server = serve();
  spindrift_options options = {};
  spindrift_room* none = nullptr;
  EXPECT_EQ(spindrift_connect(&options, 1.0, &none), SPINDRIFT_BAD_ARGUMENT);
  EXPECT_THAT(spindrift_error(), HasSubstr("expected http://HOST:PORT"));
  EXPECT_EQ(spindrift_connect(nullptr, 1.0, &none), SPINDRIFT_BAD_ARGUMENT);
  const std::string url = server.url();
  options.url = url.c_str();
  EXPECT_EQ(spindrift_connect(&options, std::nan(""), &none), SPINDRIFT_BAD_ARGUMENT);
  options.room = "nowhere";
  EXPECT_EQ(spindrift_connect(&options, 30.0, &none), SPINDRIFT_REFUSED);
  EXPECT_THAT(spindrift_error(), HasSubstr("404"));
  EXPECT_EQ(none, nullptr);
  options.room = nullptr;
  options.token = "a-token-of-nobody-at-all";
  EXPECT_EQ(spindrift_connect(&options, 30.0, &none), SPINDRIFT_REFUSED);
  const Room room = connect(url);
  ASSERT_TRUE(room);
  spindrift_moment moment = {};
  std::vector<spindrift_sample> samples(1025);
  std::vector<float> x_m(1025), z_m(1025);
  const auto query = [&](std::size_t count) {
    return spindrift_query(room.get(), x_m.data(), z_m.data(), count, &moment, samples.data());
  };
  EXPECT_EQ(query(1025), SPINDRIFT_BAD_ARGUMENT);
  EXPECT_THAT(spindrift_error(), StartsWith("count 1025: expected 1 to 1024"));
  EXPECT_EQ(query(0), SPINDRIFT_BAD_ARGUMENT);
  z_m[1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(query(2), SPINDRIFT_REJECTED);
  EXPECT_THAT(spindrift_error(), AllOf(HasSubstr("NOT_FINITE"), HasSubstr("query.z_m[1]")));
  EXPECT_EQ(spindrift_follow(room.get(), x_m.data(), z_m.data(), 1, 3601), SPINDRIFT_BAD_ARGUMENT);
  EXPECT_EQ(spindrift_step(room.get(), 601, nullptr, nullptr), SPINDRIFT_BAD_ARGUMENT);
  z_m[1] = 0.0f;
  EXPECT_EQ(query(2), SPINDRIFT_OK) << spindrift_error();
}

TEST_F(CClient, ManyThreadsAskAtATime) {
  const Server server = serve();
  const Room room = connect(server.url());
  ASSERT_TRUE(room);
  std::atomic<int> answered_count = 0, rejected_count = 0;
  std::vector<std::thread> threads;
  for (int k = 0; k < 100; ++k) {
    threads.emplace_back([&, k] {
      const float x_m = 0.05f * static_cast<float>(k), z_m = 0.0f;
      spindrift_sample sample = {};
      const spindrift_status status = spindrift_query(room.get(), &x_m, &z_m, 1, nullptr, &sample);
      answered_count += status == SPINDRIFT_OK && sample.depth_m > 0.5f;
      rejected_count += status == SPINDRIFT_REJECTED && std::string(spindrift_error()) != "";
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(answered_count + rejected_count, 100);
  EXPECT_GE(answered_count, 16);
}

}  // namespace
}  // namespace spindrift::test
