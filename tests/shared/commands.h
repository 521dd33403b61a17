// Commands with the values that tests vary, the other fields left out; and their answers.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/v1/wire.pb.h>

namespace spindrift::test {

inline v1::Command splash(double depth_m = 0.5, double radius_m = 1.5) {
  v1::Command command;
  command.mutable_splash()->set_depth_m(depth_m);
  command.mutable_splash()->set_radius_m(radius_m);
  return command;
}

/// A part of a stroke with one point.
inline v1::Command stroke(std::uint32_t stroke_id, double time_s, double x_m, double z_m, bool ends = false) {
  v1::Command command;
  v1::Stroke& out = *command.mutable_stroke();
  out.set_stroke_id(stroke_id);
  out.set_ends(ends);
  v1::StrokePoint& point = *out.add_points();
  point.set_time_s(time_s);
  point.set_x_m(x_m);
  point.set_z_m(z_m);
  return command;
}

inline v1::Command setParameter(const std::string& path, double value) {
  v1::Command command;
  command.mutable_set_parameter()->set_path(path);
  command.mutable_set_parameter()->set_value(value);
  return command;
}

inline v1::Command setPaused(bool paused) {
  v1::Command command;
  command.mutable_set_paused()->set_paused(paused);
  return command;
}

inline v1::Command setSpeed(double speed) {
  v1::Command command;
  command.mutable_set_speed()->set_speed(speed);
  return command;
}

inline v1::Command reset() {
  v1::Command command;
  command.mutable_reset();
  return command;
}

inline v1::Command seededReset(std::uint64_t seed) {
  v1::Command command;
  command.mutable_reset()->set_seed(seed);
  return command;
}

inline v1::Command spawnBoat(double x_m, double z_m) {
  v1::Command command;
  command.mutable_spawn_boat()->mutable_boat()->set_x_m(x_m);
  command.mutable_spawn_boat()->mutable_boat()->set_z_m(z_m);
  return command;
}

inline v1::Command controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio) {
  v1::Command command;
  command.mutable_control_boat()->set_boat_id(boat_id);
  command.mutable_control_boat()->set_throttle_ratio(throttle_ratio);
  command.mutable_control_boat()->set_rudder_ratio(rudder_ratio);
  return command;
}

inline v1::Command takeBoat(std::uint32_t boat_id) {
  v1::Command command;
  command.mutable_take_boat()->set_boat_id(boat_id);
  return command;
}

inline v1::Command removeBoat(std::uint32_t boat_id) {
  v1::Command command;
  command.mutable_remove_boat()->set_boat_id(boat_id);
  return command;
}

inline v1::Command spawnFloater(double x_m, double z_m) {
  v1::Command command;
  command.mutable_spawn_floater()->mutable_floater()->set_x_m(x_m);
  command.mutable_spawn_floater()->mutable_floater()->set_z_m(z_m);
  return command;
}

inline v1::Command holdFloater(std::uint32_t floater_id, double x_m, double z_m) {
  v1::Command command;
  command.mutable_hold_floater()->set_floater_id(floater_id);
  command.mutable_hold_floater()->set_x_m(x_m);
  command.mutable_hold_floater()->set_z_m(z_m);
  return command;
}

inline v1::Command removeFloater(std::uint32_t floater_id) {
  v1::Command command;
  command.mutable_remove_floater()->set_floater_id(floater_id);
  return command;
}

inline v1::Command removeFloaters() {
  v1::Command command;
  command.mutable_remove_floater()->set_all(true);
  return command;
}

inline v1::Command step(std::uint32_t tick_count) {
  v1::Command command;
  command.mutable_step()->set_tick_count(tick_count);
  return command;
}

inline v1::Command changeScene(const std::string& name) {
  v1::Command command;
  command.mutable_change_scene()->set_name(name);
  return command;
}

inline v1::Command placeGauge(double x_m, double z_m) {
  v1::Command command;
  command.mutable_place_gauge()->set_x_m(x_m);
  command.mutable_place_gauge()->set_z_m(z_m);
  return command;
}

inline v1::Command removeGauge(std::uint32_t gauge_id) {
  v1::Command command;
  command.mutable_remove_gauge()->set_gauge_id(gauge_id);
  return command;
}

inline v1::Command breakingWave(v1::Side side, double amplitude_m, double length_m) {
  v1::Command command;
  command.mutable_breaking_wave()->set_side(side);
  command.mutable_breaking_wave()->set_amplitude_m(amplitude_m);
  command.mutable_breaking_wave()->set_length_m(length_m);
  return command;
}

/// The answer to a command that gave out these ids.
inline v1::Ack ackOf(std::uint64_t command_id, std::uint64_t applied_tick, std::uint32_t boat_id = 0,
                     std::uint32_t floater_id = 0, std::uint32_t gauge_id = 0) {
  v1::Ack out;
  out.set_command_id(command_id);
  out.set_applied_tick(applied_tick);
  out.set_boat_id(boat_id);
  out.set_floater_id(floater_id);
  out.set_gauge_id(gauge_id);
  return out;
}

/// The command with a number.
inline v1::Command numbered(std::uint64_t command_id, v1::Command command) {
  command.set_command_id(command_id);
  return command;
}

/// The splash with a position.
inline v1::Command at(double x_m, double z_m, v1::Command command) {
  command.mutable_splash()->set_x_m(x_m);
  command.mutable_splash()->set_z_m(z_m);
  return command;
}

inline v1::Command takeClock(double speed = 0.0, double timeout_s = 60.0) {
  v1::Command command;
  command.mutable_take_clock()->set_speed(speed);
  command.mutable_take_clock()->set_timeout_s(timeout_s);
  return command;
}

inline v1::Command releaseClock() {
  v1::Command command;
  command.mutable_release_clock();
  return command;
}

inline v1::Command waitingStep(std::uint32_t tick_count) {
  v1::Command command = step(tick_count);
  command.mutable_step()->set_waits(true);
  return command;
}

}  // namespace spindrift::test
