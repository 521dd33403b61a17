// What the sweeps over live parameters share: the shipped scenes, the values of a parameter, a room that takes them.
#pragma once

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <spindrift/scene/parameters.h>

#include "stability_scene.h"

namespace spindrift {

enum class Which { kAll, kWithWave };

/// Names of the shipped scenes, sorted. A file that is not a scene is included, so that its test reports the error.
inline std::vector<std::string> sceneNames(Which which) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(Endurance::sceneFolder())) {
    if (entry.path().extension() != ".textproto") continue;
    const auto scene = scene::loadSceneFile(entry.path());
    if (which == Which::kAll || !scene || scene->has_wave()) names.insert(entry.path().stem().string());
  }
  // "splash_wave" is "splash" without the particles, so the wave alone would be tested twice.
  std::erase_if(names, [&](const std::string& name) {
    return name.ends_with("_wave") && names.contains(name.substr(0, name.size() - 5));
  });
  return {names.begin(), names.end()};
}

/// Searches between a refused value and the scene's own, which is accepted.
double nearestTaken(const v1::ParameterDescription& parameter, double refused, const auto& takes) {
  double allowed = parameter.value();
  for (int i = 0; i < 12; ++i) {
    double middle = 0.5 * (allowed + refused);
    if (parameter.step() >= 1) middle = std::round(middle);
    (takes(parameter.path(), middle) ? allowed : refused) = middle;
  }
  return allowed;
}

}  // namespace spindrift
