// Where the program finds what it ships with: beside itself in a bundle, or in the source tree above a build tree.
#pragma once

#include <filesystem>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::core {

/// The shipped scene of that name ("harbor", "splash"), else the file. kUnavailable names both places.
core::Result<std::filesystem::path> findScene(const std::string& given);

/// The built web client: share/spindrift/web above the program, or web-client/dist of the source tree. Empty when
/// neither is there.
std::filesystem::path findWebRoot();

/// The folder with the shipped scenes; empty when it is not found.
std::filesystem::path findSceneFolder();

}  // namespace spindrift::core
