// Converts domain values back to messages: answers, roles, and commands for the log of a room.
#include <algorithm>
#include <array>
#include <optional>
#include <variant>

#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

v1::Side toWire(core::Side side) {
  switch (side) {
    case core::Side::kPlusX:
      return v1::SIDE_PLUS_X;
    case core::Side::kMinusX:
      return v1::SIDE_MINUS_X;
    case core::Side::kPlusZ:
      return v1::SIDE_PLUS_Z;
    case core::Side::kMinusZ:
      return v1::SIDE_MINUS_Z;
    case core::Side::kDirection:
      break;
  }
  return v1::SIDE_DIRECTION;
}

void write(v1::Command& out, const core::Splash& splash) {
  v1::Splash& wire = *out.mutable_splash();
  wire.set_x_m(splash.x_m);
  wire.set_z_m(splash.z_m);
  wire.set_radius_m(splash.radius_m);
  wire.set_depth_m(splash.depth_m);
  wire.set_duration_s(splash.duration_s);
}

void write(v1::Command& out, const core::BreakingWave& wave) {
  v1::BreakingWave& wire = *out.mutable_breaking_wave();
  wire.set_side(toWire(wave.side));
  wire.set_amplitude_m(wave.amplitude_m);
  wire.set_length_m(wave.length_m);
  wire.set_duration_s(wave.duration_s);
  wire.set_shape(wave.shape == core::WaveShape::kSwell ? v1::WAVE_SHAPE_SWELL : v1::WAVE_SHAPE_BREAKING);
  wire.set_direction_deg(wave.direction_deg);
}

void write(v1::Command& out, const core::SetParameter& change) {
  out.mutable_set_parameter()->set_path(change.path);
  out.mutable_set_parameter()->set_value(change.value);
}

void write(v1::Command& out, const core::Reset&) {
  out.mutable_reset();
}

void write(v1::Command& out, const core::SetPaused& pause) {
  out.mutable_set_paused()->set_paused(pause.paused);
}

void write(v1::Command& out, const core::SetSpeed& speed) {
  out.mutable_set_speed()->set_speed(speed.speed);
}

void write(v1::Command& out, const core::SpawnBoat& spawn) {
  v1::Boat& wire = *out.mutable_spawn_boat()->mutable_boat();
  wire.set_x_m(spawn.boat.x_m);
  wire.set_z_m(spawn.boat.z_m);
  wire.set_heading_deg(spawn.boat.heading_deg);
  wire.set_length_m(spawn.boat.length_m);
  wire.set_beam_m(spawn.boat.beam_m);
  wire.set_height_m(spawn.boat.height_m);
  wire.set_density_ratio(spawn.boat.density_ratio);
  wire.set_max_speed_mps(spawn.boat.max_speed_mps);
  wire.set_throttle_ratio(spawn.boat.throttle_ratio);
  wire.set_rudder_ratio(spawn.boat.rudder_ratio);
}

void write(v1::Command& out, const core::ControlBoat& control) {
  out.mutable_control_boat()->set_boat_id(control.boat_id);
  out.mutable_control_boat()->set_throttle_ratio(control.throttle_ratio);
  out.mutable_control_boat()->set_rudder_ratio(control.rudder_ratio);
}

void write(v1::Command& out, const core::RemoveBoat& remove) {
  out.mutable_remove_boat()->set_boat_id(remove.boat_id);
}

void write(v1::Command& out, const core::TakeBoat& take) {
  out.mutable_take_boat()->set_boat_id(take.boat_id);
}

void write(v1::Command& out, const core::Step& step) {
  out.mutable_step()->set_tick_count(step.tick_count);
}

void write(v1::Command& out, const core::ChangeScene& change) {
  out.mutable_change_scene()->set_name(change.name);
}

}  // namespace

v1::Role toWire(core::Role role) {
  switch (role) {
    case core::Role::kViewer:
      return v1::ROLE_VIEWER;
    case core::Role::kPlayer:
      return v1::ROLE_PLAYER;
    case core::Role::kOperator:
      break;
  }
  return v1::ROLE_OPERATOR;
}

v1::Reject toWire(const CommandRejection& rejection) {
  v1::Reject out;
  out.set_command_id(rejection.command_id);
  out.set_reason(rejection.reason);
  out.set_field(rejection.field);
  out.set_message(rejection.message);
  return out;
}

v1::Command toWire(const core::Command& command) {
  v1::Command out;
  out.set_command_id(command.command_id);
  std::visit([&](const auto& action) { write(out, action); }, command.action);
  return out;
}

}  // namespace spindrift::wire
