// The text of a scene, with and without a fidelity from the command line.
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>

#include "fuzz.h"

namespace spindrift::fuzz {
namespace {

constexpr std::string_view kLabel = "fuzz.textproto";

/// Every line of a report begins with the file's name, and none contains a control character.
bool isReport(std::string_view text) {
  while (true) {
    const std::size_t end = text.find('\n');
    if (!text.substr(0, end).starts_with(kLabel)) return false;
    if (end == std::string_view::npos) return true;
    text.remove_prefix(end + 1);
  }
}

void checkLoaded(const v1::Scene& scene) {
  v1::Scene filled = scene;
  scene::fillDefaults(filled);
  must(filled.SerializeAsString() == scene.SerializeAsString(), "a loaded scene has every default");
  must(scene::isSceneName(scene.name()), "a loaded scene has a name that a client may ask for");
  for (const v1::ParameterDescription& parameter : scene::describeParameters(scene)) {
    must(std::isfinite(parameter.value()), "a loaded scene's parameters are finite");
    must(!scene::checkParameter(scene, parameter.path(), parameter.value()),
         "a loaded scene's own values may be set again");
  }
  const core::Scene seen = scene::toCore(scene);
  must(seen.wave || seen.particles, "a loaded scene has water");
  must(!seen.wave || std::isfinite(seen.wave->depth_m), "its depth is finite");
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // The seeds are plain scene files, so the choice depends on a number that every input has.
  std::optional<v1::Fidelity> fidelity;
  if (const int choice = static_cast<int>(size % 8); v1::Fidelity_IsValid(choice) && choice > 0) {
    fidelity = static_cast<v1::Fidelity>(choice);
  }
  const auto scene = scene::parseSceneText(text, std::string(fuzz::kLabel), fidelity);
  if (scene) {
    fuzz::checkLoaded(*scene);
  } else {
    fuzz::must(fuzz::isReport(scene.error().message), "a refusal names the file in every line");
  }
  return 0;
}
