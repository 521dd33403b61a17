// Commands on floaters: their values, the sizes and positions that suit the water, and rejections.
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

#include "commands.h"
#include "parse_command.h"

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

v1::Scene basinOf(const std::string& text) {
  const auto scene = scene::parseSceneText(text, "cove.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *scene : v1::Scene{};
}

v1::Scene cove() {
  return basinOf(
      "wave { side_m: 16 depth_m: 2 }\nobstacles { rock { x_m: 4 radius_m: 1 } }\n"
      "obstacles { breakwater { x_m: -4 length_m: 4 width_m: 1 } }\nfloaters {}");
}

/// What becomes of a floater in the cove: its rejection, or one without a reason.
CommandRejection rejectionFor(const std::function<void(v1::Floater&)>& change) {
  v1::Command spawn = test::numbered(2, test::spawnFloater(0, 0));
  change(*spawn.mutable_spawn_floater()->mutable_floater());
  return completeCommand(spawn, cove()).value_or(CommandRejection{});
}

TEST(FloaterCommands, ArriveWithTheirValuesAndNoOthers) {
  const v1::Floater floater = expectCommand([](v1::Command& c) {
                                c = test::numbered(42, test::spawnFloater(-3, 1));
                                c.mutable_spawn_floater()->mutable_floater()->set_kind(v1::FLOATER_KIND_DUCK);
                                c.mutable_spawn_floater()->mutable_floater()->set_velocity_y_mps(5);
                              })
                                  .spawn_floater()
                                  .floater();
  EXPECT_EQ(floater.kind(), v1::FLOATER_KIND_DUCK);
  EXPECT_EQ(floater.x_m(), -3.0);
  EXPECT_EQ(floater.velocity_y_mps(), 5.0);
  EXPECT_FALSE(floater.has_size_m());
  const v1::HoldFloater hold = expectCommand([](v1::Command& c) {
                                 c = test::numbered(42, test::holdFloater(7, 1, -2));
                                 c.mutable_hold_floater()->set_turn_radps(-3);
                                 c.mutable_hold_floater()->set_ends(true);
                               }).hold_floater();
  EXPECT_EQ(hold.floater_id(), 7u);
  EXPECT_EQ(hold.z_m(), -2.0);
  EXPECT_EQ(hold.turn_radps(), -3.0);
  EXPECT_FALSE(hold.has_lift_m());
  EXPECT_TRUE(hold.ends());
}

TEST(FloaterCommands, OutOfRangeValueIsRejectedWithItsField) {
  const auto expectField = [](const v1::Command& sent, const std::string& field, v1::RejectReason reason) {
    const auto checked = checkCommand(sent);
    const auto* rejection = std::get_if<CommandRejection>(&checked);
    ASSERT_NE(rejection, nullptr) << field;
    EXPECT_EQ(rejection->field(), field);
    EXPECT_EQ(rejection->reason(), reason);
  };
  v1::Command command = test::spawnFloater(0, 0);
  command.mutable_spawn_floater()->mutable_floater()->set_size_m(0.01);
  expectField(command, "spawn_floater.floater.size_m", v1::REJECT_REASON_OUT_OF_RANGE);
  command = test::spawnFloater(0, 0);
  command.mutable_spawn_floater()->mutable_floater()->set_velocity_z_mps(20.5);
  expectField(command, "spawn_floater.floater.velocity_z_mps", v1::REJECT_REASON_OUT_OF_RANGE);
  command = test::spawnFloater(0, 0);
  command.mutable_spawn_floater()->mutable_floater()->set_kind(static_cast<v1::FloaterKind>(9));
  expectField(command, "spawn_floater.floater.kind", v1::REJECT_REASON_OUT_OF_RANGE);
  expectField(test::spawnFloater(std::numeric_limits<double>::quiet_NaN(), 0), "spawn_floater.floater.x_m",
              v1::REJECT_REASON_NOT_FINITE);
  expectField(test::holdFloater(1, 0, std::numeric_limits<double>::infinity()), "hold_floater.z_m",
              v1::REJECT_REASON_NOT_FINITE);
  command = test::holdFloater(1, 0, 0);
  command.mutable_hold_floater()->set_turn_radps(11);
  expectField(command, "hold_floater.turn_radps", v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST(FloaterCommands, NeedASceneWithFloaters) {
  const v1::Scene pool = basinOf("wave {}");
  const std::pair<v1::Command, std::string> cases[] = {{test::spawnFloater(0, 0), "spawn_floater"},
                                                       {test::holdFloater(1, 0, 0), "hold_floater"},
                                                       {test::removeFloater(1), "remove_floater"}};
  for (const auto& [command, field] : cases) {
    const auto rejection = checkAgainstScene(test::numbered(2, command), pool);
    ASSERT_TRUE(rejection) << field;
    EXPECT_EQ(rejection->command_id(), 2u);
    EXPECT_EQ(rejection->reason(), v1::REJECT_REASON_ABSENT_PART);
    EXPECT_EQ(rejection->field(), field);
    EXPECT_THAT(rejection->message(), HasSubstr("no floaters"));
    v1::Command completed = command;
    EXPECT_FALSE(completeCommand(completed, cove())) << field;
  }
}

TEST(FloaterCommands, AreRejectedWhereTheSceneForbidsAFloater) {
  EXPECT_EQ(rejectionFor([](v1::Floater& f) { f.set_x_m(7.8); }).field(), "spawn_floater.floater.x_m");
  EXPECT_EQ(rejectionFor([](v1::Floater& f) { f.set_z_m(-8.0); }).field(), "spawn_floater.floater.z_m");
  const CommandRejection big = rejectionFor([](v1::Floater& f) { f.set_size_m(4.5); });
  EXPECT_EQ(big.field(), "spawn_floater.floater.size_m");
  EXPECT_THAT(big.message(), HasSubstr("choose at most 4 m"));
  const CommandRejection high = rejectionFor([](v1::Floater& f) { f.set_y_m(20.5); });
  EXPECT_EQ(high.field(), "spawn_floater.floater.y_m");
  EXPECT_THAT(high.message(), HasSubstr("choose at most 20 m"));
  for (const double density : {1e-50, 1e-38, 1e-30, 0.01}) {
    const CommandRejection light = rejectionFor([density](v1::Floater& f) { f.set_density_ratio(density); });
    EXPECT_EQ(light.field(), "spawn_floater.floater.density_ratio");
    EXPECT_THAT(light.message(), HasSubstr("choose at least 0.02"));
  }
  const CommandRejection low = rejectionFor([](v1::Floater& f) { f.set_y_m(-2.1); });
  EXPECT_EQ(low.field(), "spawn_floater.floater.y_m");
  EXPECT_THAT(low.message(), HasSubstr("below the bed; choose at least -2 m"));
  for (const auto& [x_m, obstacle] : {std::pair(4.0, "obstacles[0]"), std::pair(-4.0, "obstacles[1]")}) {
    const CommandRejection aground = rejectionFor([x = x_m](v1::Floater& f) { f.set_x_m(x); });
    EXPECT_EQ(aground.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
    EXPECT_THAT(aground.message(), HasSubstr(obstacle));
  }
  EXPECT_EQ(rejectionFor([](v1::Floater& f) { f.set_x_m(7.7); }).reason(), v1::REJECT_REASON_UNSPECIFIED)
      << "0.6 m wide";
  EXPECT_EQ(rejectionFor([](v1::Floater& f) { f.set_y_m(-2.0); }).reason(), v1::REJECT_REASON_UNSPECIFIED);
}

TEST(FloaterCommands, HoldWithinTheWater) {
  v1::Command hold = test::holdFloater(1, 8.0, -8.0);
  EXPECT_FALSE(completeCommand(hold, cove()));
  EXPECT_EQ(hold.hold_floater().lift_m(), 0.2);
  v1::Command beyond = test::holdFloater(1, 0.0, 8.1);
  const auto rejection = completeCommand(beyond, cove());
  ASSERT_TRUE(rejection);
  EXPECT_EQ(rejection->field(), "hold_floater.z_m");
  EXPECT_EQ(rejection->reason(), v1::REJECT_REASON_OUT_OF_RANGE);
}

TEST(FloaterCommands, WhatIsLeftOutSuitsTheWater) {
  v1::Command empty;
  empty.mutable_spawn_floater();
  EXPECT_FALSE(completeCommand(empty, cove()));
  const v1::Floater& crate = empty.spawn_floater().floater();
  EXPECT_EQ(crate.kind(), v1::FLOATER_KIND_CRATE);
  EXPECT_EQ(crate.size_m(), 0.6);
  EXPECT_DOUBLE_EQ(crate.y_m(), 0.3) << "it stands on the rest level";
  EXPECT_EQ(crate.x_m(), 0.0);

  v1::Command small;
  small.mutable_spawn_floater();
  const v1::Scene basin = basinOf("wave { resolution_count: 32 side_m: 2 depth_m: 0.2 width_m: 1 } floaters {}");
  EXPECT_FALSE(completeCommand(small, basin));
  EXPECT_DOUBLE_EQ(small.spawn_floater().floater().size_m(), 0.25);
  EXPECT_DOUBLE_EQ(small.spawn_floater().floater().y_m(), 0.125);

  const v1::Scene rocky = basinOf("wave { side_m: 16 } floaters {} obstacles { rock { radius_m: 2 } }");
  v1::Command beside;
  beside.mutable_spawn_floater();
  EXPECT_FALSE(completeCommand(beside, rocky));
  const v1::Floater& put = beside.spawn_floater().floater();
  EXPECT_GE(std::hypot(put.x_m(), put.z_m()), 2.3);
  EXPECT_LT(std::hypot(put.x_m(), put.z_m()), 4.0);
  v1::Command placed;
  placed.mutable_spawn_floater()->mutable_floater()->set_x_m(0.5);
  EXPECT_TRUE(completeCommand(placed, rocky)) << "the sender chose this position";
}

}  // namespace
}  // namespace spindrift::wire
