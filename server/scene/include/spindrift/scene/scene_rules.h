// Rules between the fields of a scene, and between an effect and the scene it happens in.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <spindrift/core/command.h>
#include <spindrift/scene/fields.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::scene {

/// Size of the water, which limits effects and boats: that of the wave, or of the resting water of a box of particles.
struct WaterExtents {
  double side_x_m;
  double side_z_m;
  double depth_m;

  [[nodiscard]] double shorterSide_m() const { return std::min(side_x_m, side_z_m); }
};
WaterExtents waterExtentsOf(const v1::Scene& scene);

/// Returns what the scene forbids about a splash or a breaking wave; paths start with "splash" or "breaking_wave".
std::vector<FieldIssue> checkEffect(const core::Effect& effect, const v1::Scene& scene);

/// Returns what the scene forbids about the place and the size of a boat. `prefix` goes in front of each path
/// ("spawn_boat.boat."). The scene has boats and a wave.
std::vector<FieldIssue> checkBoat(const core::Boat& boat, const v1::Scene& scene, const std::string& prefix);

/// Rules between numbers of the water and what stands and floats in it: sides, sponge, obstacles, beaches, boats. They
/// hold while the scene runs too, so parameters are checked against them.
std::vector<FieldIssue> checkWater(const v1::Scene& scene);

/// Rules about texts and about which parts there are; hold whatever the numbers say. Defaults are filled in.
std::vector<FieldIssue> checkStructure(const v1::Scene& scene);

/// Rules between numbers, for a scene whose defaults are filled in and whose single fields are fine.
std::vector<FieldIssue> checkNumbers(const v1::Scene& scene);

/// Effects with defaults for what was left out.
core::Splash toCore(const v1::Splash& splash);
core::BreakingWave toCore(const v1::BreakingWave& wave);
core::Boat toCore(const v1::Boat& boat);

}  // namespace spindrift::scene
