// Boats that a client moves, over real connections: forces of the tick, whose boats they may be, bad input.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

constexpr const char* kHullPool = R"(
  wave { resolution_count: 64 side_m: 12.8 depth_m: 1 damping_per_s: 1 }
  boats { boats { length_m: 3 beam_m: 1.2 height_m: 0.8 density_ratio: 0.25 } }
  stream { frame_rate_hz: 60 }
)";
constexpr const char* kHullOperator = "operator-operator-1";

/// Guests are players.
class Hulls : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", kHullPool}, {"box", "particles {} boats { boats {} }"}, {"calm", "wave {}"}};
  }
  void adjust(service::WaterServerOptions& options) const override {
    auto access = access::Access::parse(fmt::format("operator {}\n", kHullOperator), "tokens", core::Role::kPlayer);
    ASSERT_TRUE(access) << access.error().message;
    options.access.access = *std::move(access);
  }
};

v1::Command moveBoat(double draught_m, std::uint32_t boat_id = 1) {
  v1::Command command;
  v1::MoveBoat& move = *command.mutable_move_boat();
  move.set_boat_id(boat_id);
  move.set_y_m(0.4 - draught_m);
  return command;
}

v1::HullForces nextForces(ScriptedClient& client) {
  const auto message = client.waitFor([](const v1::ServerMessage& one) { return one.has_hull_forces(); });
  if (!message) ADD_FAILURE() << "no forces came";
  return message ? message->hull_forces() : v1::HullForces();
}

TEST_F(Hulls, AckForcesAndPictureOfATickBelongTogether) {
  ScriptedClient chief = person({.token = kHullOperator});
  ASSERT_TRUE(chief.apply(setPaused(true)));
  for (const double draught_m : {0.2, 0.5}) {
    const auto applied = chief.apply(moveBoat(draught_m));
    ASSERT_TRUE(applied);
    ASSERT_TRUE(chief.apply(step(1)));
    const v1::HullForces forces = nextForces(chief);
    EXPECT_EQ(forces.tick(), *applied + 1);
    ASSERT_EQ(forces.hulls_size(), 1);
    EXPECT_EQ(forces.hulls(0).boat_id(), 1u);
    const double weight_n = 1000 * 9.81 * 3.0 * 1.2 * draught_m;
    EXPECT_NEAR(forces.hulls(0).hydrostatic().force_y_n(), weight_n, 0.01 * weight_n);
    chief.subscribe(v1::LAYER_BODIES);
    const auto frame = chief.waitFor([&](const v1::ServerMessage& one) {
      return one.has_frame() && one.frame().layer() == v1::LAYER_BODIES && one.frame().tick() == forces.tick();
    });
    ASSERT_TRUE(frame) << "no frame of tick " << forces.tick();
    EXPECT_EQ(frame->frame().state_id(), forces.state_id());
    EXPECT_EQ(frame->frame().time_s(), forces.time_s());
    chief.unsubscribe(v1::LAYER_BODIES);
  }
}

TEST_F(Hulls, ForcesComeWithTheTicksUntilTheMoveEnds) {
  ScriptedClient one = client();
  ScriptedClient other = client();
  ScriptedClient chief = person({.token = kHullOperator});
  ASSERT_TRUE(one.apply(takeBoat(1)));
  ASSERT_TRUE(one.apply(moveBoat(0.3)));
  std::uint64_t tick = 0;
  for (int k = 0; k < 5; ++k) {
    const v1::HullForces forces = nextForces(one);
    EXPECT_GT(forces.tick(), tick);
    tick = forces.tick();
  }
  v1::Command end;
  end.mutable_move_boat()->set_boat_id(1);
  end.mutable_move_boat()->set_ends(true);
  ASSERT_TRUE(one.apply(end));
  ASSERT_TRUE(chief.runFor(10));
  while (one.hasReceived(v1::ServerMessage::kHullForces)) (void)nextForces(one);
  ASSERT_TRUE(chief.runFor(20));
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kHullForces));
  EXPECT_FALSE(other.hasReceived(v1::ServerMessage::kHullForces)) << "they are for those who move the boat";
}

TEST_F(Hulls, AMoveWithoutFurtherMessagesEndsByItself) {
  ScriptedClient chief = person({.token = kHullOperator});
  const auto applied = chief.apply(moveBoat(0.3));
  ASSERT_TRUE(applied);
  std::uint64_t last = 0;
  ASSERT_TRUE(chief.runFor(60));
  while (chief.hasReceived(v1::ServerMessage::kHullForces)) last = nextForces(chief).tick();
  EXPECT_LE(last, *applied + 30);
  EXPECT_GT(last, *applied);
}

TEST_F(Hulls, BoatsOfOthersAndUnknownOnesAreRefused) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  const v1::Reject free = one.rejected(moveBoat(0.2));
  EXPECT_EQ(free.reason(), v1::REJECT_REASON_NOT_YOURS);
  EXPECT_EQ(free.field(), "move_boat.boat_id");
  ASSERT_TRUE(two.apply(takeBoat(1)));
  EXPECT_EQ(one.rejected(moveBoat(0.2)).reason(), v1::REJECT_REASON_NOT_YOURS);
  EXPECT_TRUE(two.apply(moveBoat(0.2)));
  EXPECT_EQ(two.rejected(moveBoat(0.2, 77)).reason(), v1::REJECT_REASON_UNKNOWN_BOAT);
}

TEST_F(Hulls, BadNumbersAndPlacesAreRefused) {
  ScriptedClient chief = person({.token = kHullOperator});
  const auto refused = [&](const char* field, auto set) {
    v1::Command command = moveBoat(0.2);
    set(*command.mutable_move_boat());
    const v1::Reject reject = chief.rejected(command);
    EXPECT_EQ(reject.field(), std::string("move_boat.") + field);
    return reject.reason();
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused("y_m", [](auto& m) { m.set_y_m(std::nan("")); }), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(refused("velocity_x_mps", [&](auto& m) { m.set_velocity_x_mps(inf); }), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(refused("velocity_z_mps", [](auto& m) { m.set_velocity_z_mps(1e6); }), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(refused("x_m", [](auto& m) { m.set_x_m(5000); }), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(refused("x_m", [](auto& m) { m.set_x_m(100); }), v1::REJECT_REASON_OUT_OF_RANGE) << "beyond the water";
  EXPECT_EQ(refused("roll_rad", [](auto& m) { m.set_roll_rad(3); }), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(refused("yaw_rate_radps", [](auto& m) { m.set_yaw_rate_radps(-1e3); }), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_TRUE(chief.apply(moveBoat(400))) << "below the floor";
  EXPECT_TRUE(chief.apply(moveBoat(-400))) << "in the air";
  EXPECT_NEAR(nextForces(chief).hulls(0).hydrostatic().force_x_n(), 0.0, 1e-9);
}

TEST_F(Hulls, RoomsWithoutBoatsOrWithoutAWaveSaySo) {
  ScriptedClient box = person({.token = kHullOperator}, "box");
  const v1::Reject dry = box.rejected(moveBoat(0.2));
  EXPECT_EQ(dry.reason(), v1::REJECT_REASON_ABSENT_PART);
  EXPECT_THAT(dry.message(), HasSubstr("particles only"));
  ScriptedClient calm = person({.token = kHullOperator}, "calm");
  EXPECT_EQ(calm.rejected(moveBoat(0.2)).reason(), v1::REJECT_REASON_ABSENT_PART);
}

TEST_F(Hulls, AThousandPosesAtOnceLeaveTheRoomRunning) {
  ScriptedClient chief = person({.token = kHullOperator});
  chief.subscribe(v1::LAYER_BODIES);
  for (std::uint64_t k = 0; k < 1000; ++k) {
    v1::ClientMessage message;
    *message.mutable_command() = moveBoat(0.2 + 0.0005 * static_cast<double>(k));
    message.mutable_command()->set_command_id(100000 + k);
    chief.send(message);
  }
  ASSERT_TRUE(chief.barrier());
  // Commands of the same person may still be refused as too many, so what the room sends has to show it.
  const std::uint64_t tick = nextForces(chief).tick();
  EXPECT_TRUE(chief.waitFor([&](const v1::ServerMessage& one) {
    return one.has_frame() && one.frame().layer() == v1::LAYER_BODIES && one.frame().tick() >= tick + 10;
  }));
}

}  // namespace
}  // namespace spindrift::test
