// Faults of the machine beneath a server (docs/faults.md): a device without memory, a shader that its driver does not
// compile, clients that vanish without a word.
#include <cstdlib>
#include <thread>
#include <tuple>

#include "server_fixture.h"
#include "tcp_link.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class FaultTest : public ServerTest {
 protected:
  water::SceneCatalog scenes() const override {
    folder_.write("scenes/pond.textproto", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }");
    folder_.write("scenes/large.textproto", "wave { resolution_count: 1024 side_m: 64 depth_m: 2 }");
    folder_.write("scenes/positions.textproto",
                  "particles { count: 512 layers_count: 2 headroom_m: 2 solver: PRESSURE_SOLVER_POSITION_BASED }");
    folder_.write("scenes/too_fine.textproto", "wave { resolution_count: 4096 side_m: 64 depth_m: 2 }");
    folder_.write("scenes/too_many.textproto", "particles { count: 5000000 layers_count: 2 headroom_m: 2 }");
    return water::SceneCatalog(folder_.path() / "scenes");
  }

  HttpAnswer openRoom(const std::string& name, const std::string& scene) {
    return httpRequest(server().port(), "POST", "/api/v1/rooms", "Content-Type: application/json\r\n",
                       R"({"name": ")" + name + R"(", "scene": ")" + scene + R"("})");
  }
  std::string metrics() { return httpRequest(server().port(), "GET", "/metrics").body; }
  /// Waits until the metrics contain the line; false after kPatience.
  bool metricBecomes(const std::string& line) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (metrics().find(line + "\n") == std::string::npos) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }

  TemporaryFolder folder_;
};

TEST_F(FaultTest, TooLargeScenesAreRefusedWithTheBound) {
  ScriptedClient one = client();
  for (const auto& [scene, field, bound] : {std::tuple("too_fine", "wave.resolution_count: 4096", "4194304"),
                                            std::tuple("too_many", "particles.count: 5000000", "4194240")}) {
    SCOPED_TRACE(scene);
    const v1::Reject reject = one.rejected(changeScene(scene));
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_UNKNOWN_SCENE);
    EXPECT_THAT(reject.message(), AllOf(HasSubstr(field), HasSubstr(bound)));
    const HttpAnswer refused = openRoom("a", scene);
    EXPECT_EQ(refused.status, 500u);
    EXPECT_THAT(refused.body, AllOf(HasSubstr(field), HasSubstr(bound)));
  }
  EXPECT_TRUE(one.runFor(5));
}

class FullDevice : public FaultTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(::setenv("SPINDRIFT_GPU_CHECKS", "memory=16", 1), 0);
    FaultTest::SetUp();
  }
  void TearDown() override { ::unsetenv("SPINDRIFT_GPU_CHECKS"); }
};

TEST_F(FullDevice, RefusesAnotherSceneWithTheSizes) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  const v1::Reject reject = one.rejected(changeScene("large"));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_THAT(reject.message(), AllOf(HasSubstr("the device has no memory for it"),
                                      HasSubstr("MB are needed, 17 MB of"), HasSubstr("make the scene smaller")));
  EXPECT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(one.runFor(5));
  EXPECT_THAT(metrics(), HasSubstr("spindrift_water_failures_total{cause=\"memory\"} 1\n"));
}

TEST_F(FullDevice, RefusesARoomThatDoesNotFit) {
  ScriptedClient one = client();
  const HttpAnswer refused = openRoom("a", "large");
  EXPECT_EQ(refused.status, 503u) << refused.body;
  EXPECT_THAT(refused.body, HasSubstr("the device has no memory for it"));
  EXPECT_EQ(openRoom("b", "pond").status, 201u);
  EXPECT_TRUE(client("b").runFor(5));
  EXPECT_TRUE(one.runFor(5));
}

/// The shaders come from a folder, and one of them breaks while the server runs, as with a driver that does not compile
/// it.
class BrokenShader : public FaultTest {
 protected:
  void adjust(service::WaterServerOptions& options) const override {
    std::filesystem::copy(SPINDRIFT_SOURCE_DIR "/shaders", folder_.path() / "shaders",
                          std::filesystem::copy_options::recursive);
    options.device.shader_folder = (folder_.path() / "shaders").string();
  }
  void SetUp() override {
    FaultTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    folder_.write("shaders/pbf/predict.comp", "layout(local_size_x = 64) in;\nvoid main() { not_glsl(); }\n");
  }
};

TEST_F(BrokenShader, RefusesAnotherSceneWithFileAndLine) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  const v1::Reject reject = one.rejected(changeScene("positions"));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_THAT(reject.message(), AllOf(HasSubstr("pbf/predict.comp does not compile on llvmpipe"), HasSubstr("Mesa"),
                                      HasSubstr("not_glsl")));
  EXPECT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  EXPECT_TRUE(one.runFor(5));
  EXPECT_THAT(metrics(), HasSubstr("spindrift_water_failures_total{cause=\"driver\"} 1\n"));
}

TEST_F(BrokenShader, OpensNoRoomWithItAndOthersRun) {
  const HttpAnswer refused = openRoom("a", "positions");
  EXPECT_EQ(refused.status, 500u) << refused.body;
  EXPECT_THAT(refused.body, HasSubstr("pbf/predict.comp does not compile on llvmpipe"));
  EXPECT_EQ(openRoom("b", "pond").status, 201u);
  EXPECT_TRUE(client("b").runFor(5));
}

/// A client behind a proxy that stops forwarding. The parameter: whether it watches the water, so that writes to it
/// stall.
class HalfOpen : public FaultTest, public testing::WithParamInterface<bool> {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", "wave { resolution_count: 64 side_m: 16 depth_m: 1 } boats { capacity_count: 4 }"}};
  }
  void adjust(service::WaterServerOptions& options) const override {
    options.network.idle_timeout = std::chrono::seconds(3);
    options.rules.grace = kGrace;
    auto tokens = access::Access::parse("operator operator-of-the-test\n", "tokens", core::Role::kPlayer);
    ASSERT_TRUE(tokens) << tokens.error().message;
    options.access.access = *std::move(tokens);  // guests are players, who may take a boat only when it has no owner
  }

  static constexpr std::chrono::seconds kGrace{2};

  static double throttleOf(const v1::LayerFrame& frame, std::uint32_t boat_id) {
    const auto bodies = codec::decodeBodies(frame);
    if (!bodies) return -1.0;
    for (const auto& body : *bodies) {
      if (body.boat_id == boat_id) return body.throttle_ratio;
    }
    return -1.0;
  }
};

TEST_P(HalfOpen, ClientIsCutOffAndItsBoatBecomesFree) {
  ScriptedClient bob = person({.name = "Bob"});
  bob.subscribe(v1::LAYER_BODIES);
  TcpLink link(server().port());
  ScriptedClient ada(link.port());
  ASSERT_TRUE(ada.isOpen());
  ada.hello({.name = "Ada"});
  ASSERT_NE(ada.welcome().person_id(), 0u);
  if (GetParam()) ada.subscribe(v1::LAYER_SURFACE);
  const std::uint32_t boat_id = ada.ask(spawnBoat(0, 4)).ack().boat_id();
  ASSERT_TRUE(ada.apply(controlBoat(boat_id, 0.5, 0)));
  link.cut();
  const auto begin = std::chrono::steady_clock::now();

  ASSERT_TRUE(bob.waitFor([&](const v1::ServerMessage& message) {
    return std::ranges::any_of(message.people().people(),
                               [](const v1::Person& p) { return p.name() == "Ada" && p.away(); });
  }));
  const std::chrono::duration<double> noticed = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(noticed.count(), 1.0) << "before its time";
  double throttle_ratio = -1.0;
  for (int k = 0; k < 600 && throttle_ratio != 0.0; ++k) {
    const auto frame = bob.nextFrame(v1::LAYER_BODIES);
    if (frame) throttle_ratio = throttleOf(*frame, boat_id);
  }
  EXPECT_EQ(throttle_ratio, 0.0) << "nobody steers the boat any more";
  EXPECT_EQ(bob.rejected(takeBoat(boat_id)).reason(), v1::REJECT_REASON_NOT_YOURS) << "she may come back to it";
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!bob.ask(takeBoat(boat_id)).has_ack() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(bob.apply(controlBoat(boat_id, 0.5, 0)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, kGrace + std::chrono::seconds(1));
  EXPECT_TRUE(metricBecomes("spindrift_silent_sessions_total 1"));
  EXPECT_THAT(metrics(), HasSubstr("spindrift_sessions 1\n"));
  RecordProperty("noticed_s", std::to_string(noticed.count()));
}

INSTANTIATE_TEST_SUITE_P(Idle, HalfOpen, testing::Values(false), [](const auto&) { return "Silent"; });
INSTANTIATE_TEST_SUITE_P(Watching, HalfOpen, testing::Values(true), [](const auto&) { return "Silent"; });

}  // namespace
}  // namespace spindrift::test
