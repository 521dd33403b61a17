// Domain commands: what people ask of a room, already parsed and in range. Metres, seconds.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace spindrift::core {

/// The surface is pushed down in a disc and let go.
struct Splash {
  double x_m = 0.0;
  double z_m = 0.0;
  double radius_m = 1.5;
  double depth_m = 0.8;     ///< depression at the centre
  double duration_s = 0.2;  ///< length of the smooth pulse
};

/// Where a wave comes from.
enum class Side { kPlusX, kMinusX, kPlusZ, kMinusZ };

/// A crest released along a side, travelling across the water.
struct BreakingWave {
  Side side = Side::kPlusX;
  double amplitude_m = 0.6;
  double length_m = 3.0;    ///< full width of the crest at half height
  double duration_s = 0.5;  ///< length of the smooth pulse
};

using Effect = std::variant<Splash, BreakingWave>;

/// One field of the scene, by its proto path ("particles.viscosity_pas"), within its range; step rules are checked when
/// it is applied.
struct SetParameter {
  std::string path;
  double value = 0.0;
};

struct Reset {};
struct SetPaused {
  bool paused = false;
};
/// Simulated seconds per wall second wanted, 0.1..4.
struct SetSpeed {
  double speed = 1.0;
};

using Action = std::variant<Splash, BreakingWave, SetParameter, Reset, SetPaused, SetSpeed>;

/// A command on its way to a room. `session_id` 0 is the scene itself.
struct Command {
  std::uint64_t session_id = 0;
  std::uint64_t command_id = 0;  ///< the client's own number, echoed in Ack and Reject
  Action action;
};

}  // namespace spindrift::core
