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
#include <spindrift/sim/water_sim.h>
#include <spindrift/wire/client_message.h>

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
    const core::Action action = any(water);
    if (wire::checkAgainstScene(core::Command{{}, 1, action}, scene_)) return false;
    if (const auto* splash = std::get_if<core::Splash>(&action)) return static_cast<bool>(water.start(*splash));
    if (const auto* wave = std::get_if<core::BreakingWave>(&action)) return static_cast<bool>(water.start(*wave));
    if (const auto* spawn = std::get_if<core::SpawnBoat>(&action))
      return static_cast<bool>(water.spawnBoat(spawn->boat));
    if (const auto* control = std::get_if<core::ControlBoat>(&action))
      return static_cast<bool>(water.controlBoat(control->boat_id, control->throttle_ratio, control->rudder_ratio));
    if (const auto* remove = std::get_if<core::RemoveBoat>(&action))
      return static_cast<bool>(water.removeBoat(remove->boat_id));
    if (const auto* set = std::get_if<core::SetParameter>(&action)) {
      v1::Scene changed = scene_;
      if (scene::setParameter(changed, set->path, set->value)) return false;
      if (!water.setScene(scene::toCore(changed))) return false;
      scene_ = std::move(changed);
      ++accepted_[set->path];
      return true;
    }
    water.reset();
    return true;
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
  core::Action any(const sim::WaterSim& water) {
    const double half_m = scene_.wave().side_m() / 2;
    const auto boats = water.boats();
    const int kind = dice_.upTo(1000);
    if (kind < 1 && sends_ == Sends::kEverything) return core::Reset{};
    if (kind < 250) {
      return core::Splash{dice_.between(-half_m, half_m), dice_.between(-half_m, half_m), dice_.between(0.2, 3.0),
                          dice_.between(0.05, 1.0), dice_.between(0.05, 0.6)};
    }
    if (kind < 400) {
      return core::BreakingWave{static_cast<core::Side>(dice_.upTo(5)),
                                dice_.between(0.05, 1.0),
                                dice_.between(0.5, 8.0),
                                dice_.between(0.1, 1.0),
                                static_cast<core::WaveShape>(dice_.upTo(2)),
                                dice_.between(-180, 180)};
    }
    if (kind < 500) {
      return core::SpawnBoat{core::Boat{.x_m = dice_.between(-half_m, half_m),
                                        .z_m = dice_.between(-half_m, half_m),
                                        .heading_deg = dice_.between(-180, 180),
                                        .length_m = dice_.between(0.8, 5.0),
                                        .beam_m = dice_.between(0.3, 0.8),
                                        .height_m = dice_.between(0.2, 0.8),
                                        .density_ratio = dice_.between(0.1, 0.9),
                                        .max_speed_mps = dice_.between(1.0, 12.0)}};
    }
    if (kind < 750 && !boats.empty()) {
      return core::ControlBoat{boats[static_cast<std::size_t>(dice_.upTo(static_cast<int>(boats.size())))].boat_id,
                               dice_.between(-1, 1), dice_.between(-1, 1)};
    }
    if (kind < 800 && !boats.empty())
      return core::RemoveBoat{boats[static_cast<std::size_t>(dice_.upTo(static_cast<int>(boats.size())))].boat_id};
    if (sends_ == Sends::kEffectsAndBoats) return any(water);
    // Parameters that make a step several times as expensive are always set back at the next change of a parameter,
    // after a few ticks, so that a run of 10,000 commands ends in time.
    if (costly_) return core::SetParameter{std::exchange(costly_, nullptr)->path(), costly_value_before_};
    // In turn, so that a short run tries all of them.
    const auto& parameter = parameters_[next_parameter_++ % parameters_.size()];
    double value = dice_.between(parameter.min(), parameter.max());
    if (parameter.step() >= 1) value = std::round(value);
    if (isCostly(parameter.path())) {
      costly_ = &parameter;
      costly_value_before_ = parameter.value();
    }
    return core::SetParameter{parameter.path(), value};
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
  std::map<std::string, int> accepted_;  ///< changes of each parameter that the room took
  Dice dice_{20231121};
};

}  // namespace spindrift
