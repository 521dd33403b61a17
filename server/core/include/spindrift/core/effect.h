// What can be added to the water: splashes, waves and boats. Metres, seconds.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <spindrift/core/scene_defaults.h>

namespace spindrift::core {

/// Presses the surface down in a disc, then releases it.
struct Splash {
  using Default = defaults::Splash;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double radius_m = Default::radius_m;
  double depth_m = Default::depth_m;        ///< depression at the centre
  double duration_s = Default::duration_s;  ///< length of the smooth pulse
};

/// The side that a wave starts from; kDirection: given by `direction_deg`.
enum class Side { kPlusX, kMinusX, kPlusZ, kMinusZ, kDirection };

/// kBreaking has a front steep enough to break, kSwell is symmetric.
enum class WaveShape { kBreaking, kSwell };

/// A crest released along a side or in a direction, travelling across the water.
struct BreakingWave {
  using Default = defaults::BreakingWave;
  std::optional<Side> side;  ///< left out: where the water is deepest and open (sim::openSide)
  double amplitude_m = Default::amplitude_m;
  double length_m = Default::length_m;      ///< full width of the crest at half height
  double duration_s = Default::duration_s;  ///< length of the smooth pulse
  WaveShape shape = WaveShape::kBreaking;
  double direction_deg = Default::direction_deg;  ///< with Side::kDirection: direction of travel; 0 is +x, 90 is +z
};

/// A boat with its starting position and properties. Heading 0 points along +x and turns from +x toward +z.
struct Boat {
  using Default = defaults::Boat;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double heading_deg = Default::heading_deg;
  double length_m = Default::length_m;
  double beam_m = Default::beam_m;
  double height_m = Default::height_m;            ///< keel to deck
  double density_ratio = Default::density_ratio;  ///< boat density over water density
  double max_speed_mps = Default::max_speed_mps;  ///< at full throttle, without wave-making resistance
  double throttle_ratio = Default::throttle_ratio;
  double rudder_ratio = Default::rudder_ratio;
};

inline constexpr std::uint32_t kMaxBoats = 16;

using Effect = std::variant<Splash, BreakingWave>;

}  // namespace spindrift::core
