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

/// The same for water that does not vary along z: a channel of four cells across.
core::Scene shallowChannel(std::uint32_t cells, double cell_m, double depth_m, double courant);

/// Makes the waves of a scene periodic along x and z.
void makePeriodic(core::Scene& scene);

/// Chooses the tick rate so that `duration_s` is a whole number of ticks, no longer than `longest_tick_s` each. Returns
/// the number.
int fitTicks(core::Scene& scene, double duration_s, double longest_tick_s);

/// A field over the water; x and z are scene coordinates. [m]
using Field2 = std::function<double(double x_m, double z_m)>;

/// Gives the scene a depth grid with a point at the middle and at the edges of every cell. `depth_m` is negative on
/// land.
void setBed(core::Scene& scene, const Field2& depth_m);

/// Elevations of the second row of cells. [m]
std::vector<double> rowOf(sim::WaterSim& water);
/// Positions of the cells along x. [m]
std::vector<double> placesAlong(const sim::WaterSim& water);

/// Still depth of the ground at the cells, negative on land. x fastest. [m]
std::vector<double> groundDepths(const core::Scene& scene, const sim::WaveLayout& layout);

/// Sets the elevation, nowhere below the ground, and velocities toward +x and +z [m/s] at the faces of wet cells. Null:
/// at rest. A step moves the velocities first, so they belong to half a tick before the elevation.
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
