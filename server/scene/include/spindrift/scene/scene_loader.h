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

/// Larger scene files are refused without parsing.
inline constexpr std::size_t kSceneFileMaxBytes = 1024 * 1024;
/// Maximum number of timed events in a scene.
inline constexpr int kSceneEventMaxCount = 256;
/// Maximum number of obstacles, and of beaches (one per side).
inline constexpr int kSceneObstacleMaxCount = 64;
inline constexpr int kSceneBeachMaxCount = 4;
/// Maximum number of wave-makers (one per side), and of rows of a series of elevations.
inline constexpr int kSceneWaveMakerMaxCount = 4;
inline constexpr int kSceneSeriesRowMaxCount = 16384;
/// Maximum number of marks of a course.
inline constexpr int kSceneMarkMaxCount = 16;
/// Maximum number of shapes of a bed.
inline constexpr int kSceneBedShapeMaxCount = 64;

/// Returns whether a scene may have this name: 1 to 64 letters, digits, '_' and '-'.
bool isSceneName(const std::string& name);

/// Reads, parses and checks a scene file. The result has every default filled in; a scene without a name gets the
/// file's name without extension. `fidelity` replaces the scene's own. Errors: kUnavailable (missing, directory,
/// unreadable), kInvalidInput (too big, or the errors of parseSceneText).
core::Result<v1::Scene> loadSceneFile(const std::filesystem::path& file,
                                      std::optional<v1::Fidelity> fidelity = std::nullopt);

/// Parses and checks the text of a scene. `file_label` names it in errors; without folder and extension it is the
/// default name of the scene. Error: kInvalidInput with every error found, one per line, in order of appearance:
/// `FILE:LINE:COLUMN: field.path: value, bound, what to do`. Rules between fields are checked only if the text can be
/// parsed. `folder`: where the files lie that the scene names (bed.grid.png, wave_makers[].series.file); nullopt
/// refuses such scenes.
core::Result<v1::Scene> parseSceneText(std::string_view text, const std::string& file_label,
                                       std::optional<v1::Fidelity> fidelity = std::nullopt,
                                       const std::optional<std::filesystem::path>& folder = std::nullopt);

/// Returns the scene as clients get it: without the depths of its grid, which are megabytes (they ask for the ground,
/// GET /api/v1/rooms/NAME/ground), and without the numbers of series of elevations.
v1::Scene forClients(const v1::Scene& scene);

/// Fills every field that was left out with its default, in the parts that are present (`stream` always is);
/// UNSPECIFIED enums become their documented default, seed 0 becomes 1. The setting, which tells those who draw the
/// water where it is, follows from its sides and parts if the scene names none. Idempotent.
void fillDefaults(v1::Scene& scene);

/// Returns "open sea", ...
std::string settingName(v1::Setting setting);

/// Converts to the simulation's form. Fields left out get their defaults.
core::Scene toCore(const v1::Scene& scene);

}  // namespace spindrift::scene
