#include <cmath>
#include <set>

#include <fmt/format.h>

#include <spindrift/core/files.h>
#include <spindrift/script/script.h>
#include <spindrift/textproto/parsed_text.h>

namespace spindrift::script {
namespace {

std::string checkTime(const char* field, double time_s) {
  if (!std::isfinite(time_s) || time_s < 0) return fmt::format("{} has to be 0 or more", field);
  return time_s <= kScriptMax_s ? "" : fmt::format("{}: {} s are more than {} s", field, time_s, kScriptMax_s);
}

/// Returns an empty string, or what is wrong with the step of a script that holds the clock. `holder`: who does.
std::string checkHeldStep(const v1::ScriptStep& step, const std::string& holder, std::set<std::string>& saved) {
  if (step.has_hash()) {
    const v1::ExpectHash& hash = step.hash();
    if (!hash.same_as().empty() && !saved.contains(hash.same_as()))
      return fmt::format("hash.same_as: no step before saves a hash as \"{}\"", hash.same_as());
    if (!hash.save().empty()) saved.insert(hash.save());
  }
  if (step.client() != holder) return "";
  const v1::Command& command = step.command().command();
  if (command.has_step() || command.has_take_clock() || command.has_release_clock())
    return "the script holds the clock through \"" + holder + "\" and makes its ticks: use at_s or wait";
  if (step.has_connect() || step.has_disconnect() || step.has_closed())
    return "the script holds the clock through \"" + holder + "\": let another client connect and disconnect";
  return "";
}

/// Returns an empty string, or what is wrong with the use of the clock.
std::string checkHeld(const v1::Script& script) {
  if (!script.hold_clock()) return script.seed() != 0 ? "seed goes with hold_clock: true" : "";
  const std::string& room = script.clients(0).room();
  for (const v1::ScriptClient& client : script.clients()) {
    if (client.room() != room)
      return fmt::format("hold_clock: the clients are in the rooms \"{}\" and \"{}\"; a script holds the clock of one",
                         room, client.room());
  }
  std::set<std::string> saved;
  for (int k = 0; k < script.steps_size(); ++k) {
    const std::string why = checkHeldStep(script.steps(k), script.clients(0).name(), saved);
    if (!why.empty()) return fmt::format("steps[{}]: {}", k, why);
  }
  return "";
}

/// Returns an empty string, or what is wrong with the step.
std::string checkStep(const v1::ScriptStep& step, const std::set<std::string>& names) {
  if (!names.contains(step.client())) return "there is no client \"" + step.client() + "\"";
  if (auto why = checkTime("at_s", step.at_s()); !why.empty()) return why;
  switch (step.what_case()) {
    case v1::ScriptStep::WHAT_NOT_SET:
      return "it says neither what to do nor what to expect";
    case v1::ScriptStep::kCommand: {
      const v1::ScriptCommand& command = step.command();
      if (command.command().action_case() == v1::Command::ACTION_NOT_SET) return "command.command is empty";
      if (!command.save_boat().empty() && !command.command().has_spawn_boat()) return "save_boat goes with spawn_boat";
      if (!command.rejected_field().empty() && command.rejected() == v1::REJECT_REASON_UNSPECIFIED) {
        return "rejected_field goes with rejected";
      }
      return "";
    }
    case v1::ScriptStep::kWait:
      return checkTime("wait.duration_s", step.wait().duration_s());
    case v1::ScriptStep::kBoat:
      return step.boat().boat().empty() == (step.boat().boat_id() == 0) ? "name the boat, or give its boat_id" : "";
    case v1::ScriptStep::kGauge: {
      const v1::ExpectGauge& gauge = step.gauge();
      if (gauge.gauge().empty()) return "gauge.gauge is empty: name a gauge of the scene";
      const bool has_bound = gauge.has_min_m() || gauge.has_max_m() || gauge.has_highest_min_m() ||
                             gauge.has_highest_max_m() || gauge.has_lowest_min_m() || gauge.has_lowest_max_m();
      return has_bound ? "" : "gauge needs a bound, such as min_m or highest_max_m";
    }
    case v1::ScriptStep::kSurface:
      return step.surface().has_min_m() || step.surface().has_max_m() ? "" : "surface needs min_m or max_m";
    default:
      return "";
  }
}

}  // namespace

core::Result<v1::Script> parseScript(const std::string& text, const std::string& label) {
  v1::Script script;
  if (const textproto::ParsedText parsed(text, script); parsed.hasErrors()) return core::invalid(parsed.report(label));
  const auto refuse = [&](const std::string& why) { return core::invalid(label + ": " + why); };
  if (script.clients_size() == 0) script.add_clients()->set_name("client");
  if (script.clients_size() > kScriptClientMaxCount) {
    return refuse(fmt::format("{} clients; at most {}", script.clients_size(), kScriptClientMaxCount));
  }
  if (script.steps_size() == 0) return refuse("there are no steps");
  if (script.steps_size() > kScriptStepMaxCount) {
    return refuse(fmt::format("{} steps; at most {}", script.steps_size(), kScriptStepMaxCount));
  }
  std::set<std::string> names;
  for (const v1::ScriptClient& client : script.clients()) {
    if (client.name().empty()) return refuse("every client needs a name");
    if (!names.insert(client.name()).second) return refuse("two clients are called \"" + client.name() + "\"");
  }
  for (int k = 0; k < script.steps_size(); ++k) {
    v1::ScriptStep& step = *script.mutable_steps(k);
    if (step.client().empty()) step.set_client(script.clients(0).name());
    if (const std::string why = checkStep(step, names); !why.empty()) {
      return refuse(fmt::format("steps[{}]: {}", k, why));
    }
    if (step.has_hash() && !script.hold_clock())
      return refuse(fmt::format("steps[{}]: hash goes with hold_clock: true", k));
  }
  if (const std::string why = checkHeld(script); !why.empty()) return refuse(why);
  return script;
}

core::Result<v1::Script> loadScript(const std::filesystem::path& file) {
  constexpr std::size_t kFileMaxBytes = 4u << 20;
  const auto text = core::readText(file, kFileMaxBytes, "a script", "give fewer steps");
  if (!text) return core::Error{text.error().code, file.string() + ": " + text.error().message};
  return parseScript(*text, file.string());
}

}  // namespace spindrift::script
