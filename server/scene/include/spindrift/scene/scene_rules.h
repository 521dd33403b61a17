// Rules between the fields of a scene, and between an effect and its scene.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <spindrift/core/cell_counts.h>
#include <spindrift/core/scene.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/to_core.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Share of a side that allows for rounding of positions exactly on an edge.
inline constexpr double kEdgeToleranceRatio = 1e-9;

/// Size of the water, which limits effects and boats: of the wave, or of the resting water in a box of particles.
struct WaterExtents {
  double side_x_m;
  double side_z_m;
  double depth_m;

  [[nodiscard]] double shorterSide_m() const { return std::min(side_x_m, side_z_m); }
};
WaterExtents waterExtentsOf(const v1::Scene& scene);

/// Returns the cells of a wave; fields that are left out have their defaults.
core::WaveCells waveCellsOf(const v1::WaveScene& wave);

/// Returns what waves do at a side; at that toward +x for SIDE_UNSPECIFIED and SIDE_DIRECTION.
v1::WaveBoundary boundaryOf(const v1::WaveScene& wave, v1::Side side);

/// Checks that the width is a whole number of cells, and that there are not too many of them. Each field is valid.
void checkCells(const v1::WaveScene& wave, std::vector<FieldIssue>& issues);

/// Returns the violations by a splash or a breaking wave in this scene; paths start with "splash" or "breaking_wave".
std::vector<FieldIssue> checkEffect(const core::Effect& effect, const v1::Scene& scene);

/// Returns true for tools that act on a disc around the finger: rain and calm.
bool isDisc(v1::StrokeTool tool);

/// Returns the violations by a stroke in this scene; paths start with "stroke".
std::vector<FieldIssue> checkStroke(const v1::Stroke& stroke, const v1::Scene& scene);

/// Returns the violations by a boat's position and size. `prefix` is put in front of each path ("spawn_boat.boat.").
/// The scene has boats and a wave.
std::vector<FieldIssue> checkBoat(const core::Boat& boat, const v1::Scene& scene, const std::string& prefix);

/// Returns the violations by a floater's size and position; `prefix` as for boats. The scene has a wave.
std::vector<FieldIssue> checkFloater(const core::Floater& floater, const v1::Scene& scene, const std::string& prefix);

/// Returns the violations by a position that has to be on the water; `prefix` as for boats.
std::vector<FieldIssue> checkPlace(double x_m, double z_m, const v1::Scene& scene, const std::string& prefix);

/// Fills in the fields that were left out: with their defaults, or where the scene does not permit those, with the
/// nearest values that it permits. Without a position, a boat or a floater is put at the free position nearest to the
/// middle of the water; without a height, a floater lies on the rest level. `scene` has its defaults filled in; with a
/// boat it has boats and a wave, with a floater a wave.
void completeEffect(v1::Splash& splash, const v1::Scene& scene);
void completeEffect(v1::BreakingWave& wave, const v1::Scene& scene);
void completeBoat(v1::Boat& boat, const v1::Scene& scene);
void completeFloater(v1::Floater& floater, const v1::Scene& scene);

/// Fills in what was left out of a stroke: a point in the middle, and a size that suits the water.
void completeStroke(v1::Stroke& stroke, const v1::Scene& scene);

/// Checks rules between the water and sides, sponge, obstacles, beaches, boats, floaters and wave-makers. They hold in
/// a running scene too, so parameter changes are checked against them.
std::vector<FieldIssue> checkWater(const v1::Scene& scene);

/// Checks rules on texts and on which parts are present, independent of numbers. Defaults are filled in.
std::vector<FieldIssue> checkStructure(const v1::Scene& scene);

/// Checks rules between numbers, for a scene with defaults filled in and every single field valid.
std::vector<FieldIssue> checkNumbers(const v1::Scene& scene);

}  // namespace spindrift::scene
