// Scene files: textproto of spindrift.v1.Scene to a checked scene with every default filled in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// A scene file larger than this is refused unread.
inline constexpr std::size_t kSceneFileMaxBytes = 1024 * 1024;
/// Most timed events a scene may hold.
inline constexpr int kSceneEventMaxCount = 256;
/// Most obstacles, and most beaches: one a side.
inline constexpr int kSceneObstacleMaxCount = 64;
inline constexpr int kSceneBeachMaxCount = 4;

/// Returns whether a scene may have this name: 1 to 64 letters, digits, '_' and '-'.
bool isSceneName(const std::string& name);

/// Reads, parses and checks a scene file. The result has every default filled in; a scene that leaves out its name gets
/// the file's name without its ending. `fidelity` takes the place of the scene's own. Errors: kUnavailable (missing,
/// directory, unreadable), kInvalidInput (too big, or the errors of parseSceneText).
core::Result<v1::Scene> loadSceneFile(const std::filesystem::path& file,
                                      std::optional<v1::Fidelity> fidelity = std::nullopt);

/// Parses and checks the text of a scene; `file_label` names it in errors and, without folder and ending, the scene.
/// Error: kInvalidInput with every error found, one per line, in order of appearance:
/// `FILE:LINE:COLUMN: field.path: value, bound, what to do`. Rules between fields are checked once the text itself
/// parses.
core::Result<v1::Scene> parseSceneText(std::string_view text, const std::string& file_label,
                                       std::optional<v1::Fidelity> fidelity = std::nullopt);

/// Fills every field that was left out with its default, in the parts that are present (`stream` always is);
/// UNSPECIFIED enums become their documented default, seed 0 becomes 1. Idempotent.
void fillDefaults(v1::Scene& scene);

/// The scene as the simulation sees it, field for field. Fields left out count as their defaults.
core::Scene toCore(const v1::Scene& scene);

}  // namespace spindrift::scene
