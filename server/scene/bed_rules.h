// Rules of a scene's bed and gauges. Called by checkStructure() and checkWater().
#pragma once

#include <vector>

#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Counts, names, and shapes that are missing.
void checkBedStructure(const v1::Scene& scene, std::vector<FieldIssue>& issues);

/// Sizes and positions, in a scene with a wave.
void checkBedNumbers(const v1::Scene& scene, std::vector<FieldIssue>& issues);

}  // namespace spindrift::scene
