// The wave-makers of a scene: their rules, and their series of elevations.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Adds the numbers of the files that series name. `folder`: that of the scene file, which the files may not leave;
/// nullopt where a scene has no file, then they are refused. Adds what is wrong to `issues`.
void readSeries(v1::Scene& scene, const std::optional<std::filesystem::path>& folder, std::vector<FieldIssue>& issues);

/// Waves that are missing or excluded by each other.
void checkMakerStructure(const v1::Scene& scene, std::vector<FieldIssue>& issues);

/// Sides, heights over the depth, and series, in a scene with a wave. Rules that need the waves' lengths are those of
/// sim::derive().
void checkMakerNumbers(const v1::Scene& scene, std::vector<FieldIssue>& issues);

}  // namespace spindrift::scene
