// Domain commands: what people ask of a room, already parsed and in range. Metres, seconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

/// Where a wave comes from; kDirection: as `direction_deg` says.
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
  double direction_deg = 0.0;  ///< with Side::kDirection: where it travels to; 0 is +x, 90 is +z
};

/// A boat as it comes to the water. Heading 0 points along +x and turns from +x toward +z.
struct Boat {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
  double length_m = 2.4;
  double beam_m = 0.9;
  double height_m = 0.6;       ///< keel to deck
  double density_ratio = 0.4;  ///< over the water's
  double max_speed_mps = 5.0;  ///< at full throttle in calm water
  double throttle_ratio = 0.0;
  double rudder_ratio = 0.0;
};

inline constexpr std::uint32_t kMaxBoats = 16;

struct SpawnBoat {
  Boat boat;
};
/// -1..1 each; stays until the next one.
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

/// Ticks that a paused room advances.
struct Step {
  std::uint32_t tick_count = 1;
};
/// By the name that the greeting lists.
struct ChangeScene {
  std::string name;
};

using Action = std::variant<Splash, BreakingWave, SetParameter, Reset, SetPaused, SetSpeed, SpawnBoat, ControlBoat,
                            RemoveBoat, Step, ChangeScene, TakeBoat>;

/// Permissions of a sender; each role includes the ones before.
enum class Role { kViewer, kPlayer, kOperator };

/// "viewer", "player", "operator".
std::string_view roleName(Role role);
/// nullopt for a name that is not a role.
std::optional<Role> parseRole(std::string_view name);

/// The lowest role that may carry out the action.
Role roleFor(const Action& action);

/// Identifies one connection for the life of the process; never 0, never reused.
using SessionId = std::uint64_t;

/// Who asks: a session, or a request by HTTP. Exactly one id is not 0, unless the room itself asks.
struct Sender {
  SessionId session_id = 0;
  std::uint64_t request_id = 0;
  std::uint32_t person_id = 0;  ///< of the session, in its room; 0: nobody in particular
  Role role = Role::kOperator;
};

/// A command on its way to a room.
struct Command {
  Sender sender{};
  std::uint64_t command_id = 0;  ///< the client's own number, echoed in Ack and Reject
  Action action{};
};

}  // namespace spindrift::core
