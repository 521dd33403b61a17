// Nonlinear shallow water for cases: scenes without losses, starting states, exact dam breaks.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

/// A basin between walls with a nonlinear bulk, without damping and friction, one wave step per tick.
/// `courant`: share of a cell that a long wave of the still depth crosses in a tick.
core::Scene shallowScene(std::uint32_t resolution_count, double cell_m, double depth_m, double courant);

/// Still depth of the ground at the cells, negative on land. n x n, x fastest. [m]
std::vector<double> groundDepths(const core::Scene& scene, const sim::WaveLayout& layout);

/// A field over the water; x and z are scene coordinates. [m]
using Field2 = std::function<double(double x_m, double z_m)>;

/// Sets the elevation, nowhere below the ground, and velocities toward +x and +z [m/s] at the faces of wet cells. Null:
/// at rest.
void setShallowState(sim::WaterSim& water, const Field2& eta_m, const Field2& u_mps = nullptr,
                     const Field2& w_mps = nullptr);

/// Depth and velocity of a dam break at x from the dam, time t. `low_m` 0: dry bed (Ritter 1892); otherwise wet (Stoker
/// 1957).
struct DamBreak {
  double gravity_mps2;
  double high_m;
  double low_m;
  struct Flow {
    double depth_m;
    double velocity_mps;
  };
  [[nodiscard]] Flow at(double x_m, double time_s) const;
};

}  // namespace spindrift::study
