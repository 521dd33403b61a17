#include <algorithm>
#include <cmath>
#include <exception>
#include <set>
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
constexpr const char* kNoWave = "this scene has no wave to measure; choose a scene that has";
constexpr const char* kNoWaveForHulls =
    "this scene has particles only, whose forces on hulls are not measured; choose a scene with a wave";
constexpr const char* kNoFloaters = "this scene has no floaters; choose a scene that has";

CommandRejection rejectionOf(std::uint64_t command_id, scene::FieldIssue issue) {
  return rejection(issue.reason, std::move(issue.path), std::move(issue.message), command_id);
}

/// Returns what is wrong with the tools of a lesson; empty: nothing.
std::string checkTools(const v1::Lesson& lesson) {
  std::set<int> seen;
  for (const int tool : lesson.tools()) {
    if (tool == v1::TOOL_UNSPECIFIED || !v1::Tool_IsValid(tool))
      return std::to_string(tool) + " is not a tool; choose 1 to " + std::to_string(v1::Tool_MAX);
    if (!seen.insert(tool).second) return v1::Tool_Name(tool) + " is named twice; name each tool once";
  }
  return "";
}

/// Adds what a game needs and the scene does not have.
void checkGame(v1::GameKind kind, const v1::Scene& scene, std::vector<scene::FieldIssue>& issues) {
  const v1::Course& course = scene.course();
  if (kind == v1::GAME_KIND_BALL && !(course.has_red_goal() && course.has_blue_goal()))
    return scene::addAbsent(issues, "start_game.kind", "this scene has no goals; choose a scene whose course has two");
  if (kind == v1::GAME_KIND_BALL && !scene.has_floaters())
    return scene::addAbsent(issues, "start_game.kind", kNoFloaters);
  if (kind == v1::GAME_KIND_RACE && course.marks_size() == 0)
    return scene::addAbsent(issues, "start_game.kind", "this scene has no marks; choose a scene with a course");
  if (kind == v1::GAME_KIND_RACE && !scene.has_boats()) scene::addAbsent(issues, "start_game.kind", kNoBoats);
}

/// Adds what is wrong with the points of a query.
void checkPoints(const v1::Query& query, std::vector<scene::FieldIssue>& issues) {
  using Values = google::protobuf::RepeatedField<float>;
  const auto add = [&](v1::RejectReason reason, std::string field, std::string why) {
    issues.push_back({reason, "query." + std::move(field), std::move(why)});
  };
  const int count = query.x_m_size();
  if (static_cast<std::size_t>(count) > kQueryMaxPoints) {
    return add(v1::REJECT_REASON_OUT_OF_RANGE, "x_m",
               std::to_string(count) + " points are more than " + std::to_string(kQueryMaxPoints) +
                   "; ask for fewer at a time");
  }
  if (query.z_m_size() != count) {
    return add(
        v1::REJECT_REASON_OUT_OF_RANGE, "z_m",
        std::to_string(query.z_m_size()) + " values for " + std::to_string(count) + " of x_m; give one per point");
  }
  const std::pair<const char*, const Values*> velocities[] = {{"velocity_x_mps", &query.velocity_x_mps()},
                                                              {"velocity_z_mps", &query.velocity_z_mps()}};
  for (const auto& [name, values] : velocities) {
    if (values->size() <= 1 || values->size() == count) continue;
    return add(v1::REJECT_REASON_OUT_OF_RANGE, name,
               std::to_string(values->size()) + " values for " + std::to_string(count) +
                   " points; give none, one for all, or one per point");
  }
  const std::pair<const char*, const Values*> positions[] = {{"x_m", &query.x_m()}, {"z_m", &query.z_m()}};
  for (const auto& fields : {positions, velocities}) {
    for (int f = 0; f < 2; ++f) {
      const auto& [name, values] = fields[f];
      const auto bad = std::ranges::find_if(*values, [](float value) { return !std::isfinite(value); });
      if (bad == values->end()) continue;
      return add(v1::REJECT_REASON_NOT_FINITE, name + ("[" + std::to_string(bad - values->begin())) + "]",
                 core::formatNumber(*bad) + " is not a finite number; send a finite one");
    }
  }
}

}  // namespace

CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message, std::uint64_t command_id) {
  CommandRejection out;
  out.set_command_id(command_id);
  out.set_reason(reason);
  out.set_field(std::move(field));
  out.set_message(std::move(message));
  return out;
}

std::variant<v1::Command, CommandRejection> checkCommand(v1::Command command) {
  const std::uint64_t id = command.command_id();
  if (command.action_case() == v1::Command::ACTION_NOT_SET) {
    return rejection(v1::REJECT_REASON_MALFORMED, "",
                     "this server does not know this kind of command; the greeting tells its version", id);
  }
  std::vector<scene::FieldIssue> issues;
  scene::checkFields(command, "", issues);
  if (command.has_query()) checkPoints(command.query(), issues);
  if (!issues.empty()) return rejectionOf(id, std::move(issues.front()));
  if (command.has_set_parameter()) {
    const v1::SetParameter& set = command.set_parameter();
    if (set.path().empty() || set.path().size() > kPathMaxBytes) {
      return rejection(v1::REJECT_REASON_UNKNOWN_PARAMETER, "set_parameter.path",
                       set.path().empty() ? "is empty; name a parameter of the greeting"
                                          : "is longer than any parameter; the greeting lists what can be set",
                       id);
    }
    if (!std::isfinite(set.value())) {
      return rejection(v1::REJECT_REASON_NOT_FINITE, core::cleanText(set.path(), kPathMaxBytes),
                       core::formatNumber(set.value()) + " is not a finite number; send a finite one", id);
    }
  }
  if (command.has_change_scene() && !scene::isSceneName(command.change_scene().name())) {
    return rejection(v1::REJECT_REASON_UNKNOWN_SCENE, "change_scene.name",
                     "\"" + core::cleanText(command.change_scene().name(), kNameEchoMaxBytes) +
                         "\" is not a scene; the greeting lists what there is",
                     id);
  }
  if (auto why = checkTools(command.set_lesson().lesson()); !why.empty())
    return rejection(v1::REJECT_REASON_OUT_OF_RANGE, "set_lesson.lesson.tools", std::move(why), id);
  command.DiscardUnknownFields();
  return command;
}

namespace {

ClientMessage parseSubscribe(const v1::Subscribe& subscribe) {
  if (!v1::Layer_IsValid(subscribe.layer()) || subscribe.layer() == v1::LAYER_UNSPECIFIED) {
    return core::invalid("subscribe.layer: " + std::to_string(subscribe.layer()) +
                         " is not a layer; the greeting lists the room's layers");
  }
  if (!v1::Packing_IsValid(subscribe.packing())) {
    return core::invalid("subscribe.packing: " + std::to_string(subscribe.packing()) +
                         " is neither plain (0) nor packed (1)");
  }
  const std::optional<core::Level> level = codec::fromWire(subscribe.level());
  if (!level) {
    return core::invalid("subscribe.level: " + std::to_string(subscribe.level()) +
                         " is not a level; full (0), coarse (1), medium (2) and fine (3) are");
  }
  std::vector<scene::FieldIssue> issues;
  scene::checkFields(subscribe, "subscribe.", issues);
  if (!issues.empty()) return core::invalid(issues.front().path + ": " + issues.front().message);
  return Subscribe{subscribe.layer(), subscribe.max_rate_hz(), subscribe.packing(), *level, subscribe.adapts()};
}

ClientMessage parseChecked(core::ByteView bytes) {
  if (bytes.size() > kParseMaxBytes) {
    return core::invalid("message of " + std::to_string(bytes.size()) +
                         " bytes is too big; the greeting tells the limit");
  }
  v1::ClientMessage message;
  {
    // Protobuf would log every message with invalid UTF-8, so that a client could flood standard error.
    const google::protobuf::LogSilencer silencer;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
      return core::invalid("not a spindrift.v1.ClientMessage; send one serialized message in each binary frame");
    }
  }
  switch (message.message_case()) {
    case v1::ClientMessage::kHello: {
      v1::Hello& hello = *message.mutable_hello();
      hello.DiscardUnknownFields();  // rooms of a cluster keep it while they are asked
      hello.set_client(core::cleanName(hello.client(), kClientNameMaxBytes));
      hello.set_name(core::cleanName(hello.name(), kPersonNameMaxBytes));
      hello.set_color_rgb(hello.color_rgb() & 0xFFFFFFu);
      if (hello.resume_key().size() > kResumeKeyMaxBytes) hello.clear_resume_key();
      return std::move(hello);
    }
    case v1::ClientMessage::kSubscribe:
      return parseSubscribe(message.subscribe());
    case v1::ClientMessage::kCommand:
      return std::visit([](auto checked) -> ClientMessage { return checked; },
                        checkCommand(std::move(*message.mutable_command())));
    case v1::ClientMessage::kPing:
      if (!std::isfinite(message.ping().client_time_s())) {
        return core::invalid("ping.client_time_s: " + core::formatNumber(message.ping().client_time_s()) +
                             " is not a finite number; send seconds");
      }
      return message.ping();
    case v1::ClientMessage::MESSAGE_NOT_SET:
      break;
  }
  return core::invalid("message of a kind that this server does not know; it speaks version " +
                       std::to_string(kWireMajor) + "." + std::to_string(kWireMinor));
}

}  // namespace

ClientMessage parseClientMessage(core::ByteView bytes) {
  try {
    return parseChecked(bytes);
  } catch (const std::exception& error) {
    return core::invalid(std::string("message could not be parsed: ") + error.what());
  }
}

std::optional<std::string> checkVersion(const v1::Version& client) {
  if (client.major() == kWireMajor) return std::nullopt;
  return "client speaks wire version " + std::to_string(client.major()) + "." + std::to_string(client.minor()) +
         ", this server " + std::to_string(kWireMajor) + "." + std::to_string(kWireMinor) +
         "; use a client of the same major version";
}

std::optional<std::string> checkWater(std::uint32_t minor, const v1::Scene& scene) {
  if (minor >= kRectangleMinor || !scene.has_wave()) return std::nullopt;
  const core::WaveCells cells = scene::waveCellsOf(scene.wave());
  if (cells.count.x == cells.count.z) return std::nullopt;
  return "this water is " + core::formatNumber(cells.length_m) + " x " + core::formatNumber(cells.width_m) +
         " m, and wire version " + std::to_string(kWireMajor) + "." + std::to_string(minor) +
         " knows squares only; update the client to " + std::to_string(kWireMajor) + "." +
         std::to_string(kRectangleMinor) + " (a page: reload)";
}

v1::Role toWire(core::Role role) {
  switch (role) {
    case core::Role::kViewer:
      return v1::ROLE_VIEWER;
    case core::Role::kPlayer:
      return v1::ROLE_PLAYER;
    case core::Role::kOperator:
      break;
  }
  return v1::ROLE_OPERATOR;
}

std::optional<core::Role> fromWire(v1::Role role) {
  for (const core::Role one : {core::Role::kViewer, core::Role::kPlayer, core::Role::kOperator}) {
    if (toWire(one) == role) return one;
  }
  return std::nullopt;
}

std::optional<CommandRejection> completeCommand(v1::Command& command, const v1::Scene& scene) {
  if (command.has_splash()) scene::completeEffect(*command.mutable_splash(), scene);
  if (command.has_breaking_wave()) scene::completeEffect(*command.mutable_breaking_wave(), scene);
  if (command.has_spawn_boat()) {
    v1::Boat& boat = *command.mutable_spawn_boat()->mutable_boat();
    if (scene.has_boats()) scene::completeBoat(boat, scene);
  }
  if (command.has_spawn_floater()) {
    v1::Floater& floater = *command.mutable_spawn_floater()->mutable_floater();
    if (scene.has_floaters()) scene::completeFloater(floater, scene);
  }
  if (command.has_stroke()) scene::completeStroke(*command.mutable_stroke(), scene);
  if (command.has_set_lesson()) command.mutable_set_lesson()->mutable_lesson();  // left out: that of the beginning
  scene::fillMessageDefaults(command);
  return checkAgainstScene(command, scene);
}

std::optional<CommandRejection> checkAgainstScene(const v1::Command& command, const v1::Scene& scene) {
  std::vector<scene::FieldIssue> issues;
  const auto needBoats = [&](const char* field) {
    if (!scene.has_boats()) scene::addAbsent(issues, field, kNoBoats);
  };
  const auto needFloaters = [&](const char* field) {
    if (!scene.has_floaters()) scene::addAbsent(issues, field, kNoFloaters);
  };
  switch (command.action_case()) {
    case v1::Command::kSplash:
      issues = scene::checkEffect(scene::toCore(command.splash()), scene);
      break;
    case v1::Command::kBreakingWave:
      issues = scene::checkEffect(scene::toCore(command.breaking_wave()), scene);
      break;
    case v1::Command::kStroke:
      issues = scene::checkStroke(command.stroke(), scene);
      break;
    case v1::Command::kSetParameter: {
      const v1::SetParameter& set = command.set_parameter();
      if (auto issue = scene::checkParameter(scene, set.path(), set.value())) issues.push_back(std::move(*issue));
      break;
    }
    case v1::Command::kSpawnBoat:
      needBoats("spawn_boat");
      if (issues.empty())
        issues = scene::checkBoat(scene::toCore(command.spawn_boat().boat()), scene, "spawn_boat.boat.");
      break;
    case v1::Command::kControlBoat:
      needBoats("control_boat");
      break;
    case v1::Command::kRemoveBoat:
      needBoats("remove_boat");
      break;
    case v1::Command::kMoveBoat:
      needBoats("move_boat");
      if (issues.empty() && !scene.has_wave()) scene::addAbsent(issues, "move_boat", kNoWaveForHulls);
      if (issues.empty() && !command.move_boat().ends())
        issues = scene::checkPlace(command.move_boat().x_m(), command.move_boat().z_m(), scene, "move_boat.");
      break;
    case v1::Command::kTakeBoat:
      needBoats("take_boat");
      break;
    case v1::Command::kSpawnFloater:
      needFloaters("spawn_floater");
      if (issues.empty()) {
        issues = scene::checkFloater(scene::toCore(command.spawn_floater().floater()), scene, "spawn_floater.floater.");
      }
      break;
    case v1::Command::kHoldFloater:
      needFloaters("hold_floater");
      if (issues.empty()) {
        const v1::HoldFloater& hold = command.hold_floater();
        issues = scene::checkPlace(hold.x_m(), hold.z_m(), scene, "hold_floater.");
      }
      break;
    case v1::Command::kRemoveFloater:
      needFloaters("remove_floater");
      break;
    case v1::Command::kPlaceGauge: {
      const v1::PlaceGauge& gauge = command.place_gauge();
      if (!scene.has_wave()) {
        scene::addAbsent(issues, "place_gauge", kNoWave);
      } else {
        issues = scene::checkPlace(gauge.x_m(), gauge.z_m(), scene, "place_gauge.");
      }
      break;
    }
    case v1::Command::kQuery:
      if (!scene.has_wave()) scene::addAbsent(issues, "query", kNoWave);
      break;
    case v1::Command::kStartGame:
      checkGame(command.start_game().kind(), scene, issues);
      break;
    default:  // the other commands have no rules about the scene
      break;
  }
  if (issues.empty()) return std::nullopt;
  return rejectionOf(command.command_id(), std::move(issues.front()));
}

}  // namespace spindrift::wire
