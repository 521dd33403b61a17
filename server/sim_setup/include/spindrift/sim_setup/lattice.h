// Kernels and sums over the resting lattice in double precision: norms, the masses that give the lattice rest density,
// and the heights at which its layers rest.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// The virtual lattice lies this share of the spacing below the floor, at the position of the next layer.
inline constexpr double kVirtualDepthRatio = 0.5;
/// Pressure keeps particles about s/2 above the floor. This share of the spacing is the hard limit for particles that
/// pressure did not stop. Larger values lift still water; smaller ones let particles come close to the virtual ones.
inline constexpr double kFloorGapRatio = 0.1;
/// The same for position-based water on a wave: its lowest layer would sink onto the limit and lose a quarter of its
/// particles to the layers above, one by one and at up to 0.8 m/s.
inline constexpr double kPositionBasedFloorGapRatio = 0.45;

/// Factors of the shapes in shaders/particles/kernels.glsl, from the support radius H [m].
double densityNorm(core::KernelSet set, double H);
double slopeNorm(core::KernelSet set, double H);
double viscosityNorm(double H);  ///< 45 / (pi H^6)
double cubicNorm(double H);      ///< 8 / (pi H^3)

/// Returns a kernel set's W(r) [1/m^3] and -dW/dr [1/m^4].
double densityKernel(core::KernelSet set, double r, double H);
double pressureSlope(core::KernelSet set, double r, double H);

/// Returns the pressure [Pa] from density; k = c0^2. Not clamped. Same equation as shaders/sph/pressure.glsl.
double pressureOf(core::EquationOfState equation, double stiffness_m2ps2, double rho_0, double rho);

/// Returns the number of neighbours within H of a particle inside a cubic lattice of spacing s, without the particle
/// itself.
double latticeNeighbours(double s, double H);

/// Mass for which the inside of a cubic lattice of spacing s has density rho_0. [kg]
double calibratedMass(core::KernelSet set, double s, double H, double rho_0);

/// Mass of the virtual particles of a `points` x `points` floor lattice, one spacing under the lowest layer. Their
/// density replaces that of the layers missing below the floor. [kg]
double calibratedVirtualMass(core::KernelSet set, double s, double H, double rho_0, double mass_kg, int points);

/// Support of a wall: at distance d it adds f(d) = share max(1 - d / reach_m, 0)^2 of the rest density.
struct WallSupport {
  double share = 0.0;
  double reach_m = 0.0;
};

/// Returns the support that replaces the layers missing beyond a wall half a spacing away: their density, and twice
/// their pressure slope, because a wall has no pressure of its own to add to the particle's.
WallSupport calibratedWall(core::KernelSet set, double s, double H, double rho_0, double mass_kg);

/// Returns the viscosity of a flat floor, drag(d) = result times max(1 - d / reach_m, 0)^2: replaces the Laplacian of
/// the layers missing below the lowest one. Water sticks to the floor: a missing layer k counts with the speed that
/// continues an even shear through zero at the floor, -(2 k - 1) times that of the lowest layer. [1/m^2]
double calibratedFloorDrag(double s, double H, double rho_0, double mass_kg, const WallSupport& wall);

/// Returns the squared gradient of the density constraint rho/rho_0 - 1, summed over the neighbours, inside the
/// lattice. [1/m^2]
double latticeConstraintSlope2(core::KernelSet set, double s, double H, double rho_0, double mass_kg);

/// Stress of a slightly compressed lattice over the pressure of its density, from the virial sum m/(3 rho) r |dW/dr|.
/// With few neighbours the sum is less than the integral, 0.95 for Wendland C2 at H = 2 s. The stiffness is divided by
/// this ratio, so that c0^2 (rho - rho_0) is the pressure that carries water and c0 its speed of sound.
double latticeStressRatio(core::KernelSet set, double s, double H, double rho_0, double mass_kg);

/// Returns the same ratio after the lattice has settled into the loose order of resting water, measured in a column of
/// 20 layers at H = 2 s (`spindrift-study --suite accuracy`, hydrostatic column).
double settledStressRatio(core::KernelSet set);

/// Heights above the floor at which the layers of a layout rest: pressure, floor and gravity are in balance under the
/// solver's own equations. A lattice with other heights settles and stirs the water for many seconds, because SPH
/// underestimates the density near the free surface, so those layers carry nothing until they are closer.
/// `floor_points`: of the virtual lattice under coupled water; 0 = a flat floor that supports like a wall.
std::vector<double> restingLayers(const core::ParticleScene& water, const ParticleLayout& layout,
                                  double stiffness_m2ps2, double gravity_mps2, int floor_points);

}  // namespace spindrift::sim
