#include <algorithm>
#include <initializer_list>

#include <fmt/format.h>

#include <spindrift/classroom/lesson.h>
#include <spindrift/scene/fields.h>

namespace spindrift::rooms {
namespace {

const char* nameOf(v1::Tool tool) {
  switch (tool) {
    case v1::TOOL_FINGER:
      return "fingers are";
    case v1::TOOL_RAIN:
      return "rain is";
    case v1::TOOL_SPLASH:
      return "splashes are";
    case v1::TOOL_WAVE:
      return "waves are";
    case v1::TOOL_FLOAT:
      return "objects are";
    case v1::TOOL_THROW:
      return "throws are";
    case v1::TOOL_BOAT:
      return "boats are";
    default:
      return "this is";
  }
}

bool isThrown(const v1::Floater& floater) {
  return floater.velocity_x_mps() != 0.0 || floater.velocity_y_mps() != 0.0 || floater.velocity_z_mps() != 0.0;
}

/// Multiplies these fields of a message; none leaves its range.
void scaleFields(google::protobuf::Message& message, double ratio, std::initializer_list<const char*> names) {
  for (const char* const name : names) {
    const auto& field = *message.GetDescriptor()->FindFieldByName(name);
    const v1::ParameterOptions& options = *scene::parameterOptions(field);
    scene::setNumber(message, field, std::clamp(ratio * scene::numberOf(message, field), options.min(), options.max()));
  }
}

}  // namespace

v1::Tool toolOf(const v1::Command& command) {
  using C = v1::Command;
  switch (command.action_case()) {
    case C::kStroke:
      return command.stroke().tool() == v1::STROKE_TOOL_RAIN ? v1::TOOL_RAIN : v1::TOOL_FINGER;
    case C::kSplash:
      return v1::TOOL_SPLASH;
    case C::kBreakingWave:
      return v1::TOOL_WAVE;
    case C::kSpawnFloater:
      return isThrown(command.spawn_floater().floater()) ? v1::TOOL_THROW : v1::TOOL_FLOAT;
    case C::kHoldFloater:
    case C::kRemoveFloater:
      return v1::TOOL_FLOAT;
    case C::kSpawnBoat:
    case C::kTakeBoat:
    case C::kControlBoat:
    case C::kRemoveBoat:
    case C::kMoveBoat:
      return v1::TOOL_BOAT;
    default:
      return v1::TOOL_UNSPECIFIED;
  }
}

std::optional<wire::CommandRejection> refuse(const v1::Lesson& lesson, bool is_muted, core::Role role,
                                             const v1::Command& command) {
  if (role >= core::Role::kOperator || command.has_query()) return std::nullopt;  // a query changes nothing
  const auto notNow = [](std::string why) {
    return wire::rejection(v1::REJECT_REASON_NOT_NOW, "", std::move(why) + "; an operator can change that");
  };
  if (lesson.frozen()) return notNow("the room is frozen: it takes no commands of players");
  if (is_muted) return notNow("you are muted: the room takes no commands from you");
  const v1::Tool tool = toolOf(command);
  // Gauges need no tool: they do nothing to the water.
  if (tool == v1::TOOL_UNSPECIFIED || lesson.tools().empty() ||
      std::ranges::find(lesson.tools(), tool) != lesson.tools().end())
    return std::nullopt;
  return notNow(fmt::format("{} not handed out at present", nameOf(tool)));
}

void limitForce(double force_ratio, v1::Command& command) {
  using C = v1::Command;
  if (force_ratio >= 1.0) return;
  switch (command.action_case()) {
    case C::kSplash:
      return scaleFields(*command.mutable_splash(), force_ratio, {"depth_m"});
    case C::kBreakingWave:
      return scaleFields(*command.mutable_breaking_wave(), force_ratio, {"amplitude_m"});
    case C::kStroke:
      for (v1::StrokePoint& point : *command.mutable_stroke()->mutable_points())
        scaleFields(point, force_ratio, {"pressure_ratio"});
      return;
    case C::kSpawnFloater: {
      v1::Floater& floater = *command.mutable_spawn_floater()->mutable_floater();
      scaleFields(floater, force_ratio, {"velocity_x_mps", "velocity_y_mps", "velocity_z_mps"});
      const double rest_m = 0.5 * floater.size_m();  // from here it does not fall
      if (floater.y_m() > rest_m) floater.set_y_m(rest_m + force_ratio * (floater.y_m() - rest_m));
      return;
    }
    case C::kHoldFloater:
      return scaleFields(*command.mutable_hold_floater(), force_ratio, {"lift_m"});
    case C::kSpawnBoat:
      return scaleFields(*command.mutable_spawn_boat()->mutable_boat(), force_ratio, {"throttle_ratio"});
    case C::kControlBoat:
      return scaleFields(*command.mutable_control_boat(), force_ratio, {"throttle_ratio"});
    default:
      return;
  }
}

}  // namespace spindrift::rooms
