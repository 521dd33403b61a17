// Sums over the resting lattice in double precision: the kernels' norms, and the masses that give it rest density.
#pragma once

#include <vector>

namespace spindrift::sim {

/// Virtual lattice under a flat floor, which has no scene parameter of its own.
inline constexpr int kFlatFloorLattice = 5;

double poly6Norm(double H);  ///< 315 / (64 pi H^9)
double spikyNorm(double H);  ///< 45 / (pi H^6)
double cubicNorm(double H);  ///< 8 / (pi H^3)

/// Neighbours of a particle inside a cubic lattice of spacing s, within H, itself not counted.
double latticeNeighbours(double s, double H);

/// Mass with which the inside of a cubic lattice of spacing s has density rho_0 under poly6. [kg]
double calibratedMass(double s, double H, double rho_0);

/// Mass of the virtual particles of a `points` x `points` floor lattice at spacing s, half a spacing under the lowest
/// layer, that replaces what the layers missing below would have given. [kg]
double calibratedVirtualMass(double s, double H, double rho_0, double mass_kg, int points);

/// What restingLayers() needs to know of the water.
struct RestingWater {
  double spacing_m = 0.0;
  double support_radius_m = 0.0;
  double rest_density_kgpm3 = 0.0;
  double stiffness_m2ps2 = 0.0;
  double gravity_mps2 = 0.0;
  double mass_kg = 0.0;
  double virtual_mass_kg = 0.0;
  int floor_points = 5;
};

/// Heights above the floor at which the layers of a square lattice rest: pressure, floor and gravity in balance under
/// the solver's own equations. A lattice that starts elsewhere falls into place and stirs the water for many seconds,
/// because near the free surface SPH's density is too low to carry anything until the layers have moved closer.
std::vector<double> restingLayers(const RestingWater& water, int layers_count);

}  // namespace spindrift::sim
