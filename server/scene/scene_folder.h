// The folder of a scene file: what a scene may name in it.
#pragma once

#include <filesystem>
#include <string>

namespace spindrift::scene {

/// Returns the reason why a name does not stay in the folder; empty if it does.
std::string leavesFolder(const std::filesystem::path& folder, const std::filesystem::path& name);

}  // namespace spindrift::scene
