// The ground under the water and beside it, as a function of position. Pure functions of the scene. "Still depth": from
// the rest level down, positive below it and negative above it (land). [m]
#pragma once

#include <optional>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// Returns the distance from a position to a side of water that is centred on the origin. [m]
double distanceTo(core::Side side, double length_m, double width_m, double x_m, double z_m);

/// Returns the signed distance in the plane to an obstacle, or to the nearest one of a scene: negative inside;
/// +infinity without obstacles. [m]
double obstacleDistance(const core::Obstacle& obstacle, double x_m, double z_m);
double obstacleDistance(const core::Scene& scene, double x_m, double z_m);

/// Returns the still depth of the ground at a position, without obstacles: floor, beaches, grid, then the shapes in
/// order. At most wave.depth_m: what checkGround() allows beyond it is the rounding of numbers in a file. Precondition:
/// the scene has a wave.
double groundDepth(const core::Scene& scene, double x_m, double z_m);

/// Water with BULK_NONLINEAR cannot stand higher than 64 m (shared/fixed_point.h), so it does not matter how far land
/// rises above this: higher land counts as this high. The rest is for water on it.
inline constexpr double kHighestLand_m = 60.0;

/// Returns the still depth of the ground with obstacles as ground. A rock is a paraboloid of height_m over the still
/// water, which it meets at radius_m, on a cone that continues with its slope down to the bed; a breakwater is a
/// vertical wall of height_m over the still water. Land counts as at most kHighestLand_m high.
double groundDepthWithObstacles(const core::Scene& scene, double x_m, double z_m);

/// Returns the still depth where there is water at rest, 0 on land; without obstacles. [m]
double bedDepth(const core::Scene& scene, double x_m, double z_m);

/// Returns how fast the ground rises toward land, if a straight way up from this position leads there: the slope of the
/// ground, positive. Returns nullopt on land, on level ground, and on a slope that stays under water, such as a bar's.
/// Only of the scene's bed; 0 without one.
std::optional<double> shoreSlope(const core::Scene& scene, double x_m, double z_m);

/// Checks the bed against the water: points of the grid, and no ground deeper than wave.depth_m at the centre of any
/// cell. Error: kInvalidInput. Does nothing in scenes without a bed.
core::Result<void> checkGround(const core::Scene& scene);

/// Returns the side that waves come from where none is named: that with the deepest water, land and obstacles counted
/// as no depth; of sides that are about as deep, the first one that is open to the sea, otherwise the first one: +x,
/// -x, +z, -z. kPlusX in scenes without a wave.
core::Side openSide(const core::Scene& scene);

}  // namespace spindrift::sim
