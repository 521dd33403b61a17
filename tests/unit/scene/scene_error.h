// Why a scene was refused, as text.
#pragma once

#include <string>

#include <spindrift/scene/scene_loader.h>

namespace spindrift::scene {

inline std::string errorOf(const core::Result<v1::Scene>& scene) {
  return scene ? "(the scene loaded)" : scene.error().message;
}

/// Parses the text as that of a file with this name.
inline std::string errorOf(const std::string& text, const char* file = "scene.textproto") {
  return errorOf(parseSceneText(text, file));
}

}  // namespace spindrift::scene
