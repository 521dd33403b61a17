// Bytes from a client, up to the point where a command is passed to a room. Two scenes: one with every part, one with
// the wave alone.
#include <optional>
#include <string>
#include <variant>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>

#include "fuzz.h"
#include "invariants.h"

namespace spindrift::fuzz {
namespace {

v1::Scene sceneOf(const char* text) {
  const auto scene = scene::parseSceneText(text, "fuzz.textproto");
  must(static_cast<bool>(scene), "the target's own scenes load");
  return *scene;
}

void checkCommand(v1::Command command, const v1::Scene& scene) {
  const auto rejection = wire::completeCommand(command, scene);
  must(test::isChecked(command), "defaults keep it finite and in range");
  if (rejection) {
    must(rejection->reason() != v1::REJECT_REASON_UNSPECIFIED, "a rejection has a reason");
    must(!rejection->message().empty() && rejection->message().find('\n') == std::string::npos,
         "a rejection has one line");
    must(rejection->command_id() == command.command_id(), "a rejection names its command");
  } else if (command.has_set_parameter()) {
    v1::Scene changed = scene;
    must(!scene::setParameter(changed, command.set_parameter().path(), command.set_parameter().value()),
         "a parameter that is accepted can be set");
    must(!wire::checkAgainstScene(command, changed), "and set again");
  }
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  using fuzz::must;
  static const v1::Scene full = fuzz::sceneOf(
      "wave { resolution_count: 64 } particles { count: 100 } coupling {} foam {} boats {} floaters {} "
      "obstacles { rock { x_m: 4 } } storm {}");
  static const v1::Scene wave_only = fuzz::sceneOf("wave { resolution_count: 64 depth_m: 0.5 }");
  const wire::ClientMessage message = wire::parseClientMessage({data, size});
  must(test::isHarmless(message), "what comes out is finite and in range");
  if (const auto* hello = std::get_if<v1::Hello>(&message)) {
    const auto refusal = wire::checkVersion(hello->version());
    must(refusal.has_value() == (hello->version().major() != wire::kWireMajor),
         "another major version is refused, no other");
  }
  if (const auto* command = std::get_if<v1::Command>(&message)) {
    fuzz::checkCommand(*command, full);
    fuzz::checkCommand(*command, wave_only);
  }
  // The same commands as text, from the REST interface.
  const auto parsed = wire::parseCommandJson({reinterpret_cast<const char*>(data), size});
  if (const auto* command = parsed ? std::get_if<v1::Command>(&*parsed) : nullptr) {
    must(test::isChecked(*command), "what comes out of JSON is finite and in range");
    fuzz::checkCommand(*command, full);
    const auto again = wire::checkCommand(*command);
    must(std::holds_alternative<v1::Command>(again), "a command that was taken is taken again from a log");
  }
  (void)wire::parseQueryJson({reinterpret_cast<const char*>(data), size});
  (void)wire::parseCreateRoomJson({reinterpret_cast<const char*>(data), size});
  return 0;
}
