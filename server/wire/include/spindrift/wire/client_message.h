// Parses and checks client messages. The bytes are untrusted: none of these functions throws for any input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include <spindrift/core/bytes.h>
#include <spindrift/core/command.h>
#include <spindrift/core/level.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::wire {

/// Version of the wire spoken here. A client with another major version is refused; minor versions only add.
inline constexpr std::uint32_t kWireMajor = 1;
inline constexpr std::uint32_t kWireMinor = 0;
/// Bytes of Hello.client that are kept.
inline constexpr std::size_t kClientNameMaxBytes = 64;
/// Bytes of Hello.name that are kept.
inline constexpr std::size_t kPersonNameMaxBytes = 32;
/// Tokens and resume keys are shorter; more is not compared.
inline constexpr std::size_t kSecretMaxBytes = 256;

struct Hello {
  std::uint32_t major = 0;
  std::uint32_t minor = 0;
  std::string client;           ///< at most kClientNameMaxBytes of cleaned UTF-8 (see text.h); may be empty
  std::string token{};          ///< at most kSecretMaxBytes of anything; empty: a guest
  std::string name{};           ///< at most kPersonNameMaxBytes, likewise; empty also where it showed nothing
  std::uint32_t color_rgb = 0;  ///< 24 bits; 0: the server chooses
  std::string resume_key{};     ///< as token
};

struct Subscribe {
  v1::Layer layer = v1::LAYER_UNSPECIFIED;  ///< a declared layer, never UNSPECIFIED; the room may still not send it
  double max_rate_hz = 0.0;                 ///< 0..240; 0 = stop
  v1::Packing packing = v1::PACKING_PLAIN;
  core::Level level = core::Level::kFull;
  bool adapts = false;
};

struct Ping {
  double client_time_s = 0.0;  ///< finite
};

/// A command that is not carried out; becomes a Reject.
struct CommandRejection {
  std::uint64_t command_id = 0;
  v1::RejectReason reason = v1::REJECT_REASON_UNSPECIFIED;
  std::string field;    ///< "splash.radius_m"; empty where the whole command is meant
  std::string message;  ///< one line for a person
};

/// Bytes that are no client message at all, or one this server cannot answer; becomes a Refusal and a close.
struct Malformed {
  std::string message;  ///< one line for a person
};

using ClientMessage = std::variant<Hello, Subscribe, core::Command, Ping, CommandRejection, Malformed>;

/// Parses and checks one client message. Numbers in the result are finite and within the ranges of their fields, fields
/// left out have their defaults, the sender is empty (the caller knows the session).
ClientMessage parseClientMessage(core::ByteView bytes);

/// A command as parseClientMessage() takes it, wherever it came from.
std::variant<core::Command, CommandRejection> checkCommand(const v1::Command& command);

/// The command in the words of the wire: what checkCommand() makes the same command of.
v1::Command toWire(const core::Command& command);
v1::Role toWire(core::Role role);
v1::Reject toWire(const CommandRejection& rejection);

/// nullopt if this server can talk to the client, otherwise one line for a Refusal.
std::optional<std::string> checkVersion(const Hello& hello);

/// What the scene at hand forbids although the message is fine in itself: absent parts, splashes deeper or wider than
/// the water or outside of it, crests too high or too long, parameters unknown, restart-only or out of range, boats too
/// big, outside of the water or in an obstacle. nullopt = fine. `scene` has its defaults filled in.
std::optional<CommandRejection> checkAgainstScene(const core::Command& command, const v1::Scene& scene);

}  // namespace spindrift::wire
