// Clients that send random commands allowed in the scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/wire/client_message.h>

#include "stability_scene.h"

namespace spindrift {

/// Random values in a range, the same in every run.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }
  int upTo(int count) { return std::min(static_cast<int>(between(0, count)), count - 1); }

 private:
  std::mt19937 random_;
};

/// Random effects, boats and parameters over their whole ranges, within the scene's limits, as clients could send them.
class Crowd {
 public:
  enum class Sends { kEverything, kEffectsAndBoats };

  explicit Crowd(v1::Scene scene, Sends sends = Sends::kEverything)
      : scene_(std::move(scene)), parameters_(scene::describeParameters(scene_)), sends_(sends) {}

  /// Sends one command; returns whether the scene allowed it.
  bool send(sim::WaterSim& water) {
    const v1::Command command = any(water);
    if (wire::checkAgainstScene(command, scene_)) return false;
    switch (command.action_case()) {
      case v1::Command::kSplash:
        return static_cast<bool>(water.start(scene::toCore(command.splash())));
      case v1::Command::kBreakingWave:
        return static_cast<bool>(water.start(scene::toCore(command.breaking_wave())));
      case v1::Command::kStroke: {
        const v1::Stroke& stroke = command.stroke();
        sim::StrokePart part{1, ++stroke_id_, stroke.radius_m(), stroke.depth_m(), {}, stroke.ends()};
        for (const v1::StrokePoint& p : stroke.points())
          part.points.push_back({p.time_s(), p.x_m(), p.z_m(), p.pressure_ratio()});
        return static_cast<bool>(water.draw(part));
      }
      case v1::Command::kSpawnBoat:
        return static_cast<bool>(water.spawnBoat(scene::toCore(command.spawn_boat().boat())));
      case v1::Command::kControlBoat: {
        const v1::ControlBoat& control = command.control_boat();
        return static_cast<bool>(
            water.controlBoat(control.boat_id(), control.throttle_ratio(), control.rudder_ratio()));
      }
      case v1::Command::kRemoveBoat:
        return static_cast<bool>(water.removeBoat(command.remove_boat().boat_id()));
      case v1::Command::kSpawnFloater: {
        const auto floater_id = water.spawnFloater(scene::toCore(command.spawn_floater().floater()));
        if (floater_id) last_floater_id_ = *floater_id;
        return static_cast<bool>(floater_id);
      }
      case v1::Command::kHoldFloater: {
        const v1::HoldFloater& hold = command.hold_floater();
        return static_cast<bool>(water.holdFloater({.floater_id = hold.floater_id(),
                                                    .x_m = hold.x_m(),
                                                    .z_m = hold.z_m(),
                                                    .lift_m = hold.lift_m(),
                                                    .turn_radps = hold.turn_radps(),
                                                    .ends = hold.ends()}));
      }
      case v1::Command::kRemoveFloater:
        return static_cast<bool>(water.removeFloater(command.remove_floater().floater_id()));
      case v1::Command::kSetParameter: {
        const v1::SetParameter& set = command.set_parameter();
        v1::Scene changed = scene_;
        if (scene::setParameter(changed, set.path(), set.value())) return false;
        if (!water.setScene(scene::toCore(changed))) return false;
        scene_ = std::move(changed);
        ++accepted_[set.path()];
        return true;
      }
      default:
        water.reset();
        return true;
    }
  }

  /// The live parameters that no command has changed so far: always refused, or never tried.
  [[nodiscard]] std::vector<std::string> untouched() const {
    std::vector<std::string> out;
    for (const auto& parameter : parameters_) {
      if (!accepted_.contains(parameter.path())) out.push_back(parameter.path());
    }
    return out;
  }

  /// The scene with all accepted changes.
  [[nodiscard]] const v1::Scene& scene() const { return scene_; }

 private:
  /// Five of eight drop or throw something, the others hold what is there, or take it out.
  v1::Command anyOfFloaters(double half_m, double half_z_m) {
    v1::Command out;
    const int kind = dice_.upTo(8);
    const auto any_id = static_cast<std::uint32_t>(1 + dice_.upTo(static_cast<int>(last_floater_id_) + 1));
    if (kind < 5) {
      v1::Floater& floater = *out.mutable_spawn_floater()->mutable_floater();
      floater.set_kind(static_cast<v1::FloaterKind>(1 + dice_.upTo(8)));
      floater.set_x_m(dice_.between(-half_m, half_m));
      floater.set_y_m(dice_.between(-0.5, 3.0));
      floater.set_z_m(dice_.between(-half_z_m, half_z_m));
      floater.set_heading_deg(dice_.between(-180, 180));
      floater.set_size_m(dice_.between(0.1, 2.0));
      floater.set_density_ratio(dice_.between(0.02, 6.0));
      floater.set_ballast_ratio(dice_.between(-1.0, 1.0));
      floater.set_velocity_x_mps(dice_.between(-20.0, 20.0));
      floater.set_velocity_y_mps(dice_.between(-20.0, 20.0));
      floater.set_velocity_z_mps(dice_.between(-20.0, 20.0));
    } else if (kind < 7) {
      v1::HoldFloater& hold = *out.mutable_hold_floater();
      hold.set_floater_id(any_id);
      hold.set_x_m(dice_.between(-half_m, half_m));
      hold.set_z_m(dice_.between(-half_z_m, half_z_m));
      hold.set_lift_m(dice_.between(-2.0, 5.0));
      hold.set_turn_radps(dice_.between(-10.0, 10.0));
    } else {
      out.mutable_remove_floater()->set_floater_id(any_id);
    }
    return out;
  }

  v1::Command any(const sim::WaterSim& water) {
    const core::WaveCells cells = scene::waveCellsOf(scene_.wave());
    const double half_m = cells.length_m / 2, half_z_m = cells.width_m / 2;
    const double ratio = basinRatio(cells.length_m);
    const auto boats = water.boats();
    const auto anyBoat = [&] {
      return boats[static_cast<std::size_t>(dice_.upTo(static_cast<int>(boats.size())))].boat_id;
    };
    const int kind = dice_.upTo(1000);
    v1::Command out;
    if (kind < 1 && sends_ == Sends::kEverything) {
      out.mutable_reset();
    } else if (kind < 100) {
      v1::Stroke& stroke = *out.mutable_stroke();
      stroke.set_radius_m(ratio * dice_.between(0.1, 4.0));
      stroke.set_depth_m(stroke.radius_m() * dice_.between(0.05, 0.5));
      stroke.set_ends(true);
      const int count = 1 + dice_.upTo(6);
      for (int k = 0; k < count; ++k) {
        v1::StrokePoint& point = *stroke.add_points();
        point.set_time_s(0.1 * k);
        point.set_x_m(dice_.between(-half_m, half_m));
        point.set_z_m(dice_.between(-half_z_m, half_z_m));
        point.set_pressure_ratio(dice_.between(0.0, 1.0));
      }
    } else if (kind < 180 && scene_.has_floaters()) {
      out = anyOfFloaters(half_m, half_z_m);
    } else if (kind < 250) {
      v1::Splash& splash = *out.mutable_splash();
      splash.set_x_m(dice_.between(-half_m, half_m));
      splash.set_z_m(dice_.between(-half_z_m, half_z_m));
      splash.set_radius_m(ratio * dice_.between(0.2, 3.0));
      splash.set_depth_m(ratio * dice_.between(0.05, 1.0));
      splash.set_duration_s(dice_.between(0.05, 0.6));
    } else if (kind < 400) {
      v1::BreakingWave& wave = *out.mutable_breaking_wave();
      wave.set_side(static_cast<v1::Side>(1 + dice_.upTo(5)));
      wave.set_amplitude_m(ratio * dice_.between(0.05, 1.0));
      wave.set_length_m(ratio * dice_.between(0.5, 8.0));
      wave.set_duration_s(dice_.between(0.1, 1.0));
      wave.set_shape(static_cast<v1::WaveShape>(1 + dice_.upTo(2)));
      wave.set_direction_deg(dice_.between(-180, 180));
    } else if (kind < 500) {
      v1::Boat& boat = *out.mutable_spawn_boat()->mutable_boat();
      boat.set_x_m(dice_.between(-half_m, half_m));
      boat.set_z_m(dice_.between(-half_z_m, half_z_m));
      boat.set_heading_deg(dice_.between(-180, 180));
      boat.set_length_m(dice_.between(0.8, 5.0));
      boat.set_beam_m(dice_.between(0.3, 0.8));
      boat.set_height_m(dice_.between(0.2, 0.8));
      boat.set_density_ratio(dice_.between(0.1, 0.9));
      boat.set_max_speed_mps(dice_.between(1.0, 12.0));
    } else if (kind < 750 && !boats.empty()) {
      v1::ControlBoat& control = *out.mutable_control_boat();
      control.set_boat_id(anyBoat());
      control.set_throttle_ratio(dice_.between(-1, 1));
      control.set_rudder_ratio(dice_.between(-1, 1));
    } else if (kind < 800 && !boats.empty()) {
      out.mutable_remove_boat()->set_boat_id(anyBoat());
    } else if (sends_ == Sends::kEffectsAndBoats) {
      return any(water);
    } else {
      *out.mutable_set_parameter() = anyParameter();
    }
    return out;
  }

  v1::SetParameter anyParameter() {
    v1::SetParameter out;
    // Parameters that make a step several times as expensive are always set back at the next change of a parameter,
    // after a few ticks, so that a run of 10,000 commands ends in time.
    if (costly_) {
      out.set_path(std::exchange(costly_, nullptr)->path());
      out.set_value(costly_value_before_);
      return out;
    }
    // In turn, so that a short run tries all of them.
    const auto& parameter = parameters_[next_parameter_++ % parameters_.size()];
    double value = dice_.between(parameter.min(), parameter.max());
    if (parameter.step() >= 1) value = std::round(value);
    if (isCostly(parameter.path())) {
      costly_ = &parameter;
      costly_value_before_ = parameter.value();
    }
    out.set_path(parameter.path());
    out.set_value(value);
    return out;
  }

  static bool isCostly(const std::string& path) {
    return path == "particles.sound_speed_mps" || path == "particles.max_speed_mps" || path == "wave.depth_m" ||
           path == "gravity_mps2";
  }

  v1::Scene scene_;
  std::vector<v1::ParameterDescription> parameters_;
  Sends sends_;
  const v1::ParameterDescription* costly_ = nullptr;  ///< set last, to be put back next
  double costly_value_before_ = 0.0;
  std::size_t next_parameter_ = 0;
  std::uint32_t stroke_id_ = 0;
  std::uint32_t last_floater_id_ = 0;
  std::map<std::string, int> accepted_;  ///< changes of each parameter that the room took
  Dice dice_{20231121};
};

}  // namespace spindrift
