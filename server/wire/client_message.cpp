#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include <google/protobuf/stubs/logging.h>

#include <spindrift/codec/stream.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

/// Larger than any client message and than the network's own limit. Keeps sizes within Protobuf's int.
constexpr std::size_t kParseMaxBytes = 1024 * 1024;
constexpr std::size_t kPathMaxBytes = 128;
/// Maximum length of a scene name in error messages.
constexpr std::size_t kNameEchoMaxBytes = 64;
constexpr const char* kNoBoats = "this scene has no boats; choose a scene that has";

CommandRejection rejection(std::uint64_t command_id, scene::FieldIssue issue) {
  return {command_id, issue.reason, std::move(issue.path), std::move(issue.message)};
}

/// Converts the action of a command whose fields are valid.
core::Action actionOf(const v1::Command& command) {
  switch (command.action_case()) {
    case v1::Command::kSplash:
      return scene::toCore(command.splash());
    case v1::Command::kBreakingWave:
      return scene::toCore(command.breaking_wave());
    case v1::Command::kSetParameter:
      return core::SetParameter{command.set_parameter().path(), command.set_parameter().value()};
    case v1::Command::kSetPaused:
      return core::SetPaused{command.set_paused().paused()};
    case v1::Command::kSetSpeed:
      return core::SetSpeed{command.set_speed().speed()};
    case v1::Command::kSpawnBoat:
      return core::SpawnBoat{scene::toCore(command.spawn_boat().boat())};
    case v1::Command::kControlBoat:
      return core::ControlBoat{command.control_boat().boat_id(), command.control_boat().throttle_ratio(),
                               command.control_boat().rudder_ratio()};
    case v1::Command::kRemoveBoat:
      return core::RemoveBoat{command.remove_boat().boat_id()};
    case v1::Command::kStep:
      return core::Step{command.step().has_tick_count() ? command.step().tick_count() : core::Step{}.tick_count};
    case v1::Command::kChangeScene:
      return core::ChangeScene{command.change_scene().name()};
    case v1::Command::kTakeBoat:
      return core::TakeBoat{command.take_boat().boat_id()};
    case v1::Command::kReset:
    case v1::Command::ACTION_NOT_SET:
      break;
  }
  return core::Reset{};
}

}  // namespace

std::variant<core::Command, CommandRejection> checkCommand(const v1::Command& command) {
  const std::uint64_t id = command.command_id();
  if (command.action_case() == v1::Command::ACTION_NOT_SET) {
    return CommandRejection{id, v1::REJECT_REASON_MALFORMED, "",
                            "this server does not know this kind of command; the greeting tells its version"};
  }
  std::vector<scene::FieldIssue> issues;
  scene::checkFields(command, "", issues);
  if (!issues.empty()) return rejection(id, std::move(issues.front()));
  if (command.has_set_parameter()) {
    const v1::SetParameter& set = command.set_parameter();
    if (set.path().empty() || set.path().size() > kPathMaxBytes) {
      return CommandRejection{id, v1::REJECT_REASON_UNKNOWN_PARAMETER, "set_parameter.path",
                              set.path().empty() ? "is empty; name a parameter of the greeting"
                                                 : "is longer than any parameter; the greeting lists what can be set"};
    }
    if (!std::isfinite(set.value())) {
      return CommandRejection{id, v1::REJECT_REASON_NOT_FINITE, core::cleanText(set.path(), kPathMaxBytes),
                              core::formatNumber(set.value()) + " is not a finite number; send a finite one"};
    }
  }
  if (command.has_change_scene() && !scene::isSceneName(command.change_scene().name())) {
    return CommandRejection{id, v1::REJECT_REASON_UNKNOWN_SCENE, "change_scene.name",
                            "\"" + core::cleanText(command.change_scene().name(), kNameEchoMaxBytes) +
                                "\" is no scene; the greeting lists what there is"};
  }
  return core::Command{{}, id, actionOf(command)};
}

namespace {

ClientMessage parseSubscribe(const v1::Subscribe& subscribe) {
  if (!v1::Layer_IsValid(subscribe.layer()) || subscribe.layer() == v1::LAYER_UNSPECIFIED) {
    return Malformed{"subscribe.layer: " + std::to_string(subscribe.layer()) +
                     " is no layer; the greeting lists the room's layers"};
  }
  if (!v1::Packing_IsValid(subscribe.packing())) {
    return Malformed{"subscribe.packing: " + std::to_string(subscribe.packing()) +
                     " is neither plain (0) nor packed (1)"};
  }
  const std::optional<core::Level> level = codec::fromWire(subscribe.level());
  if (!level) {
    return Malformed{"subscribe.level: " + std::to_string(subscribe.level()) +
                     " is no level; full (0), coarse (1), medium (2) and fine (3) are"};
  }
  std::vector<scene::FieldIssue> issues;
  scene::checkFields(subscribe, "subscribe.", issues);
  if (!issues.empty()) return Malformed{issues.front().path + ": " + issues.front().message};
  return Subscribe{subscribe.layer(), subscribe.max_rate_hz(), subscribe.packing(), *level, subscribe.adapts()};
}

ClientMessage parseChecked(core::ByteView bytes) {
  if (bytes.size() > kParseMaxBytes) {
    return Malformed{"message of " + std::to_string(bytes.size()) + " bytes is too big; the greeting tells the limit"};
  }
  v1::ClientMessage message;
  {
    // Protobuf would log every message with invalid UTF-8, so that a client could flood standard error.
    const google::protobuf::LogSilencer silencer;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
      return Malformed{"not a spindrift.v1.ClientMessage; send one serialized message in each binary frame"};
    }
  }
  switch (message.message_case()) {
    case v1::ClientMessage::kHello: {
      const v1::Hello& hello = message.hello();
      return Hello{hello.version().major(),
                   hello.version().minor(),
                   core::cleanName(hello.client(), kClientNameMaxBytes),
                   hello.token().substr(0, kSecretMaxBytes),
                   core::cleanName(hello.name(), kPersonNameMaxBytes),
                   hello.color_rgb() & 0xFFFFFFu,
                   hello.resume_key().substr(0, kSecretMaxBytes)};
    }
    case v1::ClientMessage::kSubscribe:
      return parseSubscribe(message.subscribe());
    case v1::ClientMessage::kCommand:
      return std::visit([](auto&& checked) -> ClientMessage { return std::move(checked); },
                        checkCommand(message.command()));
    case v1::ClientMessage::kPing:
      if (!std::isfinite(message.ping().client_time_s())) {
        return Malformed{"ping.client_time_s: " + core::formatNumber(message.ping().client_time_s()) +
                         " is not a finite number; send seconds"};
      }
      return Ping{message.ping().client_time_s()};
    case v1::ClientMessage::MESSAGE_NOT_SET:
      break;
  }
  return Malformed{"message of a kind that this server does not know; it speaks version " + std::to_string(kWireMajor) +
                   "." + std::to_string(kWireMinor)};
}

}  // namespace

ClientMessage parseClientMessage(core::ByteView bytes) {
  try {
    return parseChecked(bytes);
  } catch (const std::exception& error) {
    return Malformed{std::string("message could not be parsed: ") + error.what()};
  }
}

std::optional<std::string> checkVersion(const Hello& hello) {
  if (hello.major == kWireMajor) return std::nullopt;
  return "client speaks wire version " + std::to_string(hello.major) + "." + std::to_string(hello.minor) +
         ", this server " + std::to_string(kWireMajor) + "." + std::to_string(kWireMinor) +
         "; use a client of the same major version";
}

std::optional<CommandRejection> checkAgainstScene(const core::Command& command, const v1::Scene& scene) {
  std::vector<scene::FieldIssue> issues;
  if (const auto* splash = std::get_if<core::Splash>(&command.action)) {
    issues = scene::checkEffect(*splash, scene);
  } else if (const auto* wave = std::get_if<core::BreakingWave>(&command.action)) {
    issues = scene::checkEffect(*wave, scene);
  } else if (const auto* set = std::get_if<core::SetParameter>(&command.action)) {
    if (auto error = scene::checkParameter(scene, set->path, set->value)) {
      issues.push_back({error->reason, std::move(error->field), std::move(error->message)});
    }
  } else if (const auto* spawn = std::get_if<core::SpawnBoat>(&command.action)) {
    if (scene.has_boats()) {
      issues = scene::checkBoat(spawn->boat, scene, "spawn_boat.boat.");
    } else {
      scene::addAbsent(issues, "spawn_boat", kNoBoats);
    }
  } else if (std::holds_alternative<core::ControlBoat>(command.action) && !scene.has_boats()) {
    scene::addAbsent(issues, "control_boat", kNoBoats);
  } else if (std::holds_alternative<core::RemoveBoat>(command.action) && !scene.has_boats()) {
    scene::addAbsent(issues, "remove_boat", kNoBoats);
  } else if (std::holds_alternative<core::TakeBoat>(command.action) && !scene.has_boats()) {
    scene::addAbsent(issues, "take_boat", kNoBoats);
  }
  if (issues.empty()) return std::nullopt;
  return rejection(command.command_id, std::move(issues.front()));
}

}  // namespace spindrift::wire
