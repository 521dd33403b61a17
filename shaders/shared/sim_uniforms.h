// All numbers that the passes of a step read, filled by sim from derive()'s result, once per change.
// Loops copy what they need into locals first: llvmpipe reloads a uniform in every iteration otherwise.
#ifndef SPINDRIFT_SHARED_SIM_UNIFORMS_H
#define SPINDRIFT_SHARED_SIM_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"

#ifdef __cplusplus
namespace spindrift::shared {
struct SimUniforms {
#else
layout(std140, binding = SIM_UNIFORMS) uniform SimUniforms {
#endif
  // Particles' domain and grid; cells have edge support_radius_m, y fastest, then x, then z.
  float min_x_m;
  float min_y_m;
  float min_z_m;
  float max_x_m;
  float max_y_m;
  float max_z_m;
  float support_radius_m;
  float spacing_m;
  uint particle_count;
  uint cells_x;
  uint cells_y;
  uint cells_z;
  uint cell_count;

  // SPH.
  float mass_kg;                // of a particle
  float rest_density_kgpm3;
  float stiffness_m2ps2;        // k in p = k (rho - rho0): c0^2 over the lattice's stress ratio (sim_setup/lattice.h)
  float viscosity_pas;
  float max_speed_mps;
  float gravity_mps2;
  float dt_s;                   // substep
  float density_norm;           // of the kernel set's density kernel
  float slope_norm;             // of its pressure kernel's slope
  float viscosity_norm;         // 45 / (pi H^6)
  float cubic_norm;             // 8 / (pi H^3)
  float floor_drag_pm2;         // a flat floor's share of the viscosity's Laplacian, for a particle on it
  float reentry_m;              // how far inside a periodic side a particle re-enters

  // Floor of the particles: the water surface lowered by band_m, or the plane y = -band_m.
  float band_m;                 // thickness of the resting band
  float virtual_mass_kg;        // of a virtual particle of the floor under coupled water, for density and viscosity
  float floor_gap_m;            // particles are kept this far above the floor
  float downforce_per_m_s2;

  // Coupling: end of the substep minus the end of the tick (0 in the last substep). The surface moves with its own
  // speed toward its position at the end of the tick.
  float surface_lead_s;
  // Two-way coupling.
  uint pool_capacity_count;
  uint droplet_units;           // a particle's volume in elevation units of one wave cell
  uint splat_reach_count;       // droplet exchange is spread over 4 splat_reach_count + 1 cells per axis
  float splat_width_m;          // standard deviation of that spread
  float emission_ratio;         // factor on the scene's emission
  uint spray_block_count;       // at most one cell in each square of this many cells per axis emits in a tick
  float spray_taken_m;          // maximum height of water that all particles of a tick take from a cell
  uint seed;

  // Foam.
  float foam_deficit_ratio;     // 1 - rho/rho0 at which a particle is pure foam
  float foam_keep_ratio;        // exp(-dt / lifetime), of particles
  float tick_s;
  float breaking_foam_keep_ratio;  // of the surface's foam, per tick
  float wake_foam_keep_ratio;
  float landing_foam_keep_ratio;

  float foam_neighbours;  // particles with fewer neighbours than this turn white

  // Walls: the water missing beyond a wall is f(d) = wall_share max(1 - d / wall_reach_m, 0)^2 of the rest density.
  float wall_share;
  float wall_reach_m;

  // Position-based solver: added to a constraint's squared gradient, so that lone particles do not jump.
  float constraint_softness_pm2;

  // Wave: wave_nx x wave_nz square cells, x fastest. Without a wave, the length and width are the particles' domain.
  uint wave_nx;
  uint wave_nz;
  float wave_length_m;          // along x
  float wave_width_m;           // along z
  float wave_cell_m;
  float wave_dt_s;              // wave substep
  float wave_depth_m;           // still depth away from beaches
  float wave_damping_per_s;     // kappa
  float wave_pull;              // gravity dt / dx * metres per unit: flow gained per metre of conductance and unit of slope
  float wave_transfer;          // dt / dx in units: elevation moved per flow
  float steepening_ratio;
  float breaking_loss_per_s;    // of flow, where the intensity is 1
  float wave_friction;          // g n^2, n being Manning's roughness of the bed [m^(1/3)]

  // Frames: range of the quantized positions in x and z; in y it is min_y_m to max_y_m.
  float frame_min_x_m;
  float frame_max_x_m;
  float frame_min_z_m;
  float frame_max_z_m;
  float surface_quantum_m;

  // Bound of the neighbour search: largest number of candidates of a column of cells that a particle visits
  // (sim_setup/derive.cpp).
  uint candidates_max_count;

  // Surface tension of the wave and of particles (particles/tension.glsl, sim_setup/surface_tension.h); 0 without. Last: hashes and
  // saved states of scenes without tension end before (sim/water_sim_save.cpp).
  float capillary_ratio;        // head of surface tension over the sum of a cell's height above its neighbours
  float tension_area_ps2;
  float tension_pull_ps2;
  float tension_wall_m5pkg;     // turns a gradient of boundaryDensity into one of SURFACE_GRADIENT
#ifdef __cplusplus
};
static_assert(sizeof(SimUniforms) == 72 * 4, "scalars of four bytes only: std140 and C++ must agree");
static_assert(sizeof(SimUniforms) % 16 == 0, "a uniform buffer that is smaller than its block is undefined");
}  // namespace spindrift::shared
#else
} sim;
#endif

#endif
