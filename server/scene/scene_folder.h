// Files that a scene names, in its folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::scene {

/// Most bytes of a file's name in an error.
inline constexpr std::size_t kNameEchoMaxBytes = 200;

/// Returns where a file lies that a scene names: in the folder of the scene or below, links followed. `folder`: nullopt
/// for scenes that are not files; `instead` says what those give in place of a name. Error: kInvalidInput.
core::Result<std::filesystem::path> fileInFolder(const std::optional<std::filesystem::path>& folder,
                                                 const std::filesystem::path& name, const std::string& instead);

}  // namespace spindrift::scene
