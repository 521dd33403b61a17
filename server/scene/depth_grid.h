// The depth grid of a scene's bed: from rows or an image to points.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Fills `grid.points` from its rows or its PNG, and removes the rows. `folder`: that of the scene file, which the PNG
/// may not leave; nullopt where a scene has no file, then a PNG is refused. Adds what is wrong to `issues`, with paths
/// that start with "bed.grid".
void readDepthGrid(v1::DepthGrid& grid, const std::optional<std::filesystem::path>& folder,
                   std::vector<FieldIssue>& issues);

}  // namespace spindrift::scene
