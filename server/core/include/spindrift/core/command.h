// Domain commands: the requests of sessions and REST clients, parsed and range-checked. Metres, seconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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
  Side side = Side::kPlusX;
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
  double max_speed_mps = Default::max_speed_mps;  ///< at full throttle in calm water
  double throttle_ratio = Default::throttle_ratio;
  double rudder_ratio = Default::rudder_ratio;
};

inline constexpr std::uint32_t kMaxBoats = 16;

struct SpawnBoat {
  Boat boat;
};
/// Throttle and rudder, each -1..1; in force until the next ControlBoat for the boat.
struct ControlBoat {
  std::uint32_t boat_id = 0;
  double throttle_ratio = 0.0;
  double rudder_ratio = 0.0;
};
struct RemoveBoat {
  std::uint32_t boat_id = 0;
};
struct TakeBoat {
  std::uint32_t boat_id = 0;
};

using Effect = std::variant<Splash, BreakingWave>;

/// One field of the scene, by its proto path ("particles.viscosity_pas"), within its range. Step-size rules are checked
/// when the change is applied.
struct SetParameter {
  std::string path;
  double value = 0.0;
};

struct Reset {};
struct SetPaused {
  bool paused = false;
};
/// Sets the wanted simulated seconds per wall second, 0.1..4.
struct SetSpeed {
  double speed = 1.0;
};

/// Advances a paused room by this many ticks.
struct Step {
  std::uint32_t tick_count = 1;
};
/// Changes to a scene by a name that the greeting lists.
struct ChangeScene {
  std::string name;
};

using Action = std::variant<Splash, BreakingWave, SetParameter, Reset, SetPaused, SetSpeed, SpawnBoat, ControlBoat,
                            RemoveBoat, Step, ChangeScene, TakeBoat>;

/// Permissions of a sender; each role includes the ones before.
enum class Role { kViewer, kPlayer, kOperator };

/// "viewer", "player", "operator".
std::string_view roleName(Role role);
/// Returns nullopt for a name that is not a role.
std::optional<Role> parseRole(std::string_view name);

/// Returns the lowest role that may carry out the action.
Role roleFor(const Action& action);

/// Identifies one connection for the life of the process; never 0, never reused.
using SessionId = std::uint64_t;

/// The sender of a command: a session or an HTTP request. Exactly one id is not 0, unless the room itself is the
/// sender.
struct Sender {
  SessionId session_id = 0;
  std::uint64_t request_id = 0;
  std::uint32_t person_id = 0;  ///< the session's person in its room; 0: none
  Role role = Role::kOperator;
};

/// A command on its way to a room.
struct Command {
  Sender sender{};
  std::uint64_t command_id = 0;  ///< the client's own number, echoed in Ack and Reject
  Action action{};
};

}  // namespace spindrift::core
