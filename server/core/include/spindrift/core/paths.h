// Paths of the files that the program ships with: next to the program in a bundle, or in the source tree above a build
// tree.
#pragma once

#include <filesystem>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::core {

/// Returns the shipped scene of that name ("harbor", "splash"), otherwise the file. kUnavailable names both paths.
Result<std::filesystem::path> findScene(const std::string& given);

/// Returns the folder of the built web client: share/spindrift/web above the program, or web-client/dist of the source
/// tree. Empty when neither exists.
std::filesystem::path findWebRoot();

/// Returns the folder of the shipped scenes; empty when it does not exist.
std::filesystem::path findSceneFolder();

}  // namespace spindrift::core
