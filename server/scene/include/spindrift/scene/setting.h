// Where the water of a scene is, for those who draw it. The simulation does not depend on it.
#pragma once

#include <string>

#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Returns the scene's setting, or the one that follows from its sides and parts if it names none; never unspecified.
/// Precondition: the defaults of the scene's numbers are filled in.
v1::Setting settingOf(const v1::Scene& scene);

/// Returns "open sea", ...
std::string settingName(v1::Setting setting);

}  // namespace spindrift::scene
