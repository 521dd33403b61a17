// Parses and checks client messages. The bytes are untrusted: these functions throw for no input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include <spindrift/core/bytes.h>
#include <spindrift/core/level.h>
#include <spindrift/core/result.h>
#include <spindrift/core/sender.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::wire {

/// Version of the wire protocol. Clients with another major version are refused; minor versions only add fields and
/// messages.
inline constexpr std::uint32_t kWireMajor = 1;
inline constexpr std::uint32_t kWireMinor = 11;
/// First minor version whose clients know planes that are not squares (count_z and width_m of their headers).
inline constexpr std::uint32_t kRectangleMinor = 1;
/// First minor version whose clients know Draining.
inline constexpr std::uint32_t kDrainingMinor = 2;
/// First minor version whose clients know floaters_predicted; others get floaters_fixed28.
inline constexpr std::uint32_t kPackedFloatersMinor = 7;
/// Limit of the points of a Query, and of those of a session together.
inline constexpr std::size_t kQueryMaxPoints = 1024;
/// Hello.client is cut to this length.
inline constexpr std::size_t kClientNameMaxBytes = 64;
/// Hello.name is cut to this length.
inline constexpr std::size_t kPersonNameMaxBytes = 32;
/// No server gives out a longer Hello.resume_key.
inline constexpr std::size_t kResumeKeyMaxBytes = 256;

struct Subscribe {
  v1::Layer layer = v1::LAYER_UNSPECIFIED;  ///< a declared layer, never UNSPECIFIED; a room may lack it
  double max_rate_hz = 0.0;                 ///< 0..240; 0 = stop
  v1::Packing packing = v1::PACKING_PLAIN;
  core::Level level = core::Level::kFull;
  bool adapts = false;
};

/// A command that is refused.
using CommandRejection = v1::Reject;

/// Makes a rejection. `field`: "splash.radius_m"; empty if the whole command is meant. `message`: one line for the
/// user.
CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message,
                           std::uint64_t command_id = 0);

/// An Error stands for bytes that are not a valid client message, or one that cannot be answered; becomes a Refusal and
/// a close.
using ClientMessage = std::variant<v1::Hello, Subscribe, v1::Command, v1::Ping, CommandRejection, core::Error>;

/// Parses and checks one client message. Numbers in the result are finite and in range. Names in a Hello are cleaned
/// (see text.h) and cut, a resume key that is too long is left out. Fields that a command leaves out stay empty:
/// completeCommand() fills them in.
ClientMessage parseClientMessage(core::ByteView bytes);

/// Checks a command from any source, as parseClientMessage() does. Returns it without unknown fields.
std::variant<v1::Command, CommandRejection> checkCommand(v1::Command command);

v1::Role toWire(core::Role role);
/// Returns nullopt for an unknown role.
std::optional<core::Role> fromWire(v1::Role role);

/// Returns nullopt if this server supports the client's version, otherwise one line for a Refusal.
std::optional<std::string> checkVersion(const v1::Version& client);

/// Returns nullopt if a client of this minor version can show the scene's water, otherwise one line for a Refusal:
/// clients of 1.0 take every plane for a square.
std::optional<std::string> checkWater(std::uint32_t minor, const v1::Scene& scene);

/// Fills in what a command that checkCommand() accepted leaves out, with defaults that the scene permits, and checks it
/// by checkAgainstScene(). So a log keeps the values that were in force, whatever the defaults are when it is replayed.
std::optional<CommandRejection> completeCommand(v1::Command& command, const v1::Scene& scene);

/// Checks a command that checkCommand() accepted against the scene: absent parts, splashes deeper or wider than the
/// water or outside of it, crests too high or too long, parameters unknown, restart-only or out of range, boats and
/// floaters too big, outside of the water or in an obstacle, gauges outside of the water, queries without a wave, games
/// for which the scene has no course. nullopt = allowed. `scene` has its defaults filled in.
std::optional<CommandRejection> checkAgainstScene(const v1::Command& command, const v1::Scene& scene);

}  // namespace spindrift::wire
