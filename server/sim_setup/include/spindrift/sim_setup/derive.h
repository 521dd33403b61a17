// derive(): computes the values that the passes use from the user's settings (core::Scene, SI units). The only
// conversion between the two; a pure function.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <shared/sim_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// One step-size rule: the largest step it allows, and its source.
struct StepRule {
  std::string name;   ///< "particle CFL: 0.4 H / (c0 + U_max)"
  std::string field;  ///< the scene field with the largest influence
  double max_dt_s = 0.0;
};

/// The initial particle lattice and the grid around it.
struct ParticleLayout {
  std::uint32_t count = 0;  ///< columns_x * columns_z * layers
  std::uint32_t columns_x_count = 0;
  std::uint32_t columns_z_count = 0;
  std::uint32_t layers_count = 0;
  double spacing_m = 0.0;  ///< s: s^3 is a particle's share of the filled volume
  double pitch_x_m = 0.0;  ///< lattice spacing along x: s, rounded to whole columns
  double pitch_z_m = 0.0;
  double volume_m3 = 0.0;         ///< volume of the water; a running room keeps it when its particle count changes
  double support_radius_m = 0.0;  ///< H; on periodic axes a whole number of cells spans the patch
  double mass_kg = 0.0;           ///< calibrated: the inside of the lattice has rest density
  double virtual_mass_kg = 0.0;   ///< mass of the virtual particles of a coupled floor, calibrated the same way
  double floor_drag_pm2 = 0.0;    ///< of a flat floor, see lattice.h
  double wall_share = 0.0;        ///< calibrated support of walls, see lattice.h
  double wall_reach_m = 0.0;
  double constraint_softness_pm2 = 0.0;  ///< of the position-based solver
  std::vector<double> layer_heights_m;   ///< of the resting layers above the floor, from below
  double band_m = 0.0;                   ///< thickness of the resting band: highest layer + s/2
  std::uint32_t splat_reach_count = 1;   ///< two-way: droplet exchange is spread over 4 of these + 1 cells per axis
  double neighbours_count = 0.0;         ///< inside the lattice, within H, the particle itself not counted
  std::array<double, 3> min_m{};         ///< domain x, y, z
  std::array<double, 3> max_m{};
  std::array<std::uint32_t, 3> cells{};
  std::uint32_t cell_count = 0;

  bool operator==(const ParticleLayout&) const = default;
};

struct WaveLayout {
  std::uint32_t count_x = 0;  ///< cells along x
  std::uint32_t count_z = 0;
  double length_m = 0.0;  ///< along x: count_x * cell_m
  double width_m = 0.0;   ///< along z: count_z * cell_m
  double cell_m = 0.0;
  bool is_periodic_x = false;
  bool is_periodic_z = false;
  double speed_mps = 0.0;            ///< sqrt(g d)
  double dispersing_depth_m = 0.0;   ///< d if waves disperse, otherwise 0
  std::uint32_t substeps_count = 1;  ///< wave steps per tick
  double dt_s = 0.0;                 ///< of a wave step
  double courant = 0.0;              ///< c dt / dx

  [[nodiscard]] core::CellCounts counts() const { return {count_x, count_z}; }
  /// Returns half as many along each axis, rounded up: the cells of the foam field.
  [[nodiscard]] core::CellCounts foamCounts() const { return {(count_x + 1) / 2, (count_z + 1) / 2}; }
  [[nodiscard]] double longerSide_m() const { return std::max(length_m, width_m); }
  [[nodiscard]] double shorterSide_m() const { return std::min(length_m, width_m); }
};

/// Everything that follows from a scene.
struct Derived {
  double tick_s = 0.0;
  std::uint32_t substeps_count = 1;  ///< number per tick
  double dt_s = 0.0;                 ///< tick_s / substeps_count
  std::optional<ParticleLayout> particles;
  std::optional<WaveLayout> wave;
  std::vector<StepRule> rules;     ///< all rules that apply, tightest first
  std::uint64_t device_bytes = 0;  ///< buffers of the simulation, as sim allocates them
  shared::SimUniforms uniforms{};
};

/// Errors (kInvalidInput) name the field, the value, the bound and what to do; `allow_unstable` disables the step-size
/// rules only. The loader checks ranges; derive() checks rules that need several fields.
/// `kept`: the layout of a running room. A parameter change may change the layout of a new start (softer water rests
/// lower), but the running room keeps its domain, grid and floor.
core::Result<Derived> derive(const core::Scene& scene, const ParticleLayout* kept = nullptr);

/// Returns the layout for another number of particles in a running room: the same water at the same position, so the
/// spacing is (volume / count)^(1/3), and the layers follow from it. Errors as derive().
core::Result<ParticleLayout> layOutAgain(const core::Scene& scene, const ParticleLayout& before);

/// Returns whether the change needs new buffers or programs (a restart) and not only new uniforms.
bool needsRestart(const Derived& before, const Derived& after);

}  // namespace spindrift::sim
