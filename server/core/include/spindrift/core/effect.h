// What can be added to the water: splashes, waves and boats. Metres, seconds.
#pragma once

#include <cstdint>
#include <variant>

namespace spindrift::core {

/// Presses the surface down in a disc, then releases it.
struct Splash {
  double x_m = 0.0;
  double z_m = 0.0;
  double radius_m = 1.5;
  double depth_m = 0.8;     ///< depression at the centre
  double duration_s = 0.2;  ///< length of the smooth pulse
};

/// The side that a wave starts from; kDirection: given by `direction_deg`.
enum class Side { kPlusX, kMinusX, kPlusZ, kMinusZ, kDirection };

/// kBreaking has a front steep enough to break, kSwell is symmetric.
enum class WaveShape { kBreaking, kSwell };

/// A crest released along a side or in a direction, travelling across the water.
struct BreakingWave {
  Side side = Side::kPlusX;
  double amplitude_m = 0.6;
  double length_m = 3.0;    ///< full width of the crest at half height
  double duration_s = 0.5;  ///< length of the smooth pulse
  WaveShape shape = WaveShape::kBreaking;
  double direction_deg = 0.0;  ///< with Side::kDirection: direction of travel; 0 is +x, 90 is +z
};

/// A boat with its starting position and properties. Heading 0 points along +x and turns from +x toward +z.
struct Boat {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
  double length_m = 2.4;
  double beam_m = 0.9;
  double height_m = 0.6;       ///< keel to deck
  double density_ratio = 0.4;  ///< boat density over water density
  double max_speed_mps = 5.0;  ///< at full throttle in calm water
  double throttle_ratio = 0.0;
  double rudder_ratio = 0.0;
};

inline constexpr std::uint32_t kMaxBoats = 16;

using Effect = std::variant<Splash, BreakingWave>;

}  // namespace spindrift::core
