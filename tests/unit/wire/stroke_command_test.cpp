// Strokes as clients send them: their values, the sizes that suit the water, and rejections.
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>

#include "commands.h"
#include "parse_command.h"

namespace spindrift::wire {
namespace {

using testing::HasSubstr;

v1::Scene sceneOf(const std::string& text) {
  const auto scene = scene::parseSceneText(text, "small.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *scene : v1::Scene{};
}

const char* const kPool = "wave { side_m: 20 width_m: 10 resolution_count: 64 depth_m: 2 }";

/// What becomes of a stroke in the pool: its rejection, or none with the stroke completed.
CommandRejection send(v1::Command& command) {
  auto checked = checkCommand(command);
  if (const auto* rejection = std::get_if<CommandRejection>(&checked)) return *rejection;
  command = std::get<v1::Command>(std::move(checked));
  return completeCommand(command, sceneOf(kPool)).value_or(CommandRejection{});
}

TEST(StrokeCommands, WhatIsLeftOutSuitsTheWater) {
  v1::Command command = test::stroke(3, 0.0, 1.0, 2.0);
  EXPECT_EQ(send(command).reason(), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_NEAR(command.stroke().radius_m(), 0.25, 1e-9) << "of a side of 10 m";
  EXPECT_NEAR(command.stroke().depth_m(), 0.1125, 1e-9);
  EXPECT_EQ(command.stroke().points(0).pressure_ratio(), 1.0);

  v1::Command empty;
  empty.mutable_stroke();
  EXPECT_EQ(send(empty).reason(), v1::REJECT_REASON_UNSPECIFIED);
  ASSERT_EQ(empty.stroke().points_size(), 1);
  EXPECT_EQ(empty.stroke().points(0).x_m(), 0.0);

  v1::Command end;
  end.mutable_stroke()->set_ends(true);
  EXPECT_EQ(send(end).reason(), v1::REJECT_REASON_UNSPECIFIED);
  EXPECT_EQ(end.stroke().points_size(), 0);
}

TEST(StrokeCommands, WhatCannotBeIsRejectedWithItsField) {
  const auto rejected = [](const auto& change) {
    v1::Command command = test::stroke(1, 0.0, 0.0, 0.0);
    change(*command.mutable_stroke());
    return send(command);
  };
  const auto off = rejected([](v1::Stroke& s) { s.mutable_points(0)->set_z_m(6.0); });
  EXPECT_EQ(off.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(off.field(), "stroke.points[0].z_m");
  EXPECT_THAT(off.message(), HasSubstr("lies outside of the water; choose -5 to 5 m"));

  const auto nan =
      rejected([](v1::Stroke& s) { s.mutable_points(0)->set_x_m(std::numeric_limits<double>::quiet_NaN()); });
  EXPECT_EQ(nan.reason(), v1::REJECT_REASON_NOT_FINITE);
  EXPECT_EQ(nan.field(), "stroke.points[0].x_m");

  const auto back = rejected([](v1::Stroke& s) { *s.add_points() = s.points(0); });
  EXPECT_EQ(back.field(), "stroke.points[1].time_s");
  EXPECT_THAT(back.message(), HasSubstr("not later than the point before"));

  const auto many = rejected([](v1::Stroke& s) {
    for (int k = 1; k <= 64; ++k) s.add_points()->set_time_s(0.001 * k);
  });
  EXPECT_EQ(many.field(), "stroke.points");
  EXPECT_THAT(many.message(), HasSubstr("65 points are more than 64"));

  const auto wide = rejected([](v1::Stroke& s) { s.set_radius_m(2.0); });
  EXPECT_EQ(wide.field(), "stroke.radius_m");
  EXPECT_THAT(wide.message(), HasSubstr("choose at most 1.25 m"));

  const auto steep = rejected([](v1::Stroke& s) {
    s.set_radius_m(0.5);
    s.set_depth_m(0.3);
  });
  EXPECT_EQ(steep.field(), "stroke.depth_m");
  EXPECT_THAT(steep.message(), HasSubstr("half the radius; choose at most 0.25 m"));

  const auto deep = rejected([](v1::Stroke& s) {
    s.set_radius_m(1.25);
    s.set_depth_m(0.7);
  });
  EXPECT_EQ(deep.field(), "stroke.depth_m");
}

}  // namespace
}  // namespace spindrift::wire
