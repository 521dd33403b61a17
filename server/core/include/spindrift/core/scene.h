// The scene as the simulation reads it: plain values in SI units, already validated against the ranges in proto.
// The scene module fills it from scene.proto (same fields, same names); sim::derive() computes step sizes and layouts.
// Axes: right-handed, y up, rest water level y = 0, domain centred on the origin, x and z horizontal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <spindrift/core/effect.h>

namespace spindrift::core {

/// What happens to particles at a pair of opposite sides.
enum class Boundary { kPeriodic, kWall };

/// What happens to waves at a side. Periodic sides come in pairs.
enum class WaveBoundary { kPeriodic, kReflect, kAbsorb };

/// 5-point or isotropic 9-point Laplacian of the wave equation.
enum class Stencil { kFivePoint, kNinePoint };

/// Kernels for density and pressure. kMuller (poly6 and spiky) is that of the thesis: its pressure is not the gradient
/// of its density. The others use one kernel for both, so that pressure neither adds nor removes energy.
enum class KernelSet { kMuller, kCubicSpline, kWendlandC2 };

/// kWeaklyCompressible: pressure from density through an equation of state; the speed of sound limits the step size.
/// kPositionBased: positions are moved until the density is right (Macklin & Mueller 2013); large steps.
enum class PressureSolver { kWeaklyCompressible, kPositionBased };

/// kLinear: p = c0^2 (rho - rho0). kTait: p = rho0 c0^2/7 ((rho/rho0)^7 - 1).
enum class EquationOfState { kLinear, kTait };

/// kConserving: p_i/rho_i^2 + p_j/rho_j^2, antisymmetric. kMean: (p_i + p_j)/(2 rho_i rho_j), thesis 3.17.
enum class PressureForce { kConserving, kMean };

/// The heightfield: eta_tt + kappa eta_t = div(g d grad eta).
struct WaveScene {
  std::uint32_t resolution_count = 256;  ///< cells along each side (x and z), multiple of 16
  double side_m = 24.0;                  ///< side of the square domain
  double depth_m = 1.5;                  ///< still-water depth d
  double damping_per_s = 0.1;            ///< kappa, on the velocity term only
  Stencil stencil = Stencil::kFivePoint;
  WaveBoundary boundary_minus_x = WaveBoundary::kPeriodic;
  WaveBoundary boundary_plus_x = WaveBoundary::kPeriodic;
  WaveBoundary boundary_minus_z = WaveBoundary::kPeriodic;
  WaveBoundary boundary_plus_z = WaveBoundary::kPeriodic;
  /// Sets all four sides.
  void setBoundaries(WaveBoundary all) {
    boundary_minus_x = boundary_plus_x = boundary_minus_z = boundary_plus_z = all;
  }
  double sponge_width_m = 4.0;             ///< width of the absorbing layer along a side
  double steepening_ratio = 0.0;           ///< 0: linear waves; 1: speed follows the local water depth (shallow water)
  std::uint32_t fixed_substeps_count = 0;  ///< 0 = derive() chooses; otherwise this many wave steps per tick, checked

  bool operator==(const WaveScene&) const = default;
};

/// A round rock that stands out of the water.
struct Rock {
  double x_m = 0.0;
  double z_m = 0.0;
  double radius_m = 1.0;
  double height_m = 0.8;  ///< above the still water

  bool operator==(const Rock&) const = default;
};

/// A straight wall from the bed to above the water. Heading 0 runs along x and turns from +x toward +z.
struct Breakwater {
  double x_m = 0.0;
  double z_m = 0.0;
  double length_m = 8.0;
  double width_m = 1.0;
  double heading_deg = 0.0;
  double height_m = 0.8;

  bool operator==(const Breakwater&) const = default;
};

using Obstacle = std::variant<Rock, Breakwater>;

/// The bed rises linearly over width_m toward a side, from the scene's depth to shore_depth_m at the side.
struct Beach {
  Side side = Side::kPlusX;
  double width_m = 6.0;
  double shore_depth_m = 0.0;

  bool operator==(const Beach&) const = default;
};

/// The SPH particles of a patch: a band of water, `layers` spacings thick, over part of the surface or all of it.
struct ParticleScene {
  std::uint32_t count = 8192;    ///< wanted particles; derive() rounds to a full lattice and reports the result
  double layers_count = 3.0;     ///< thickness of the resting band in particle spacings
  double patch_shift_x_m = 0.0;  ///< patch centre
  double patch_shift_z_m = 0.0;
  double patch_scale = 1.0;    ///< patch side over wave side (over `box_side_m` without a wave), 0..1
  double box_side_m = 24.0;    ///< side of the horizontal box when the scene has no wave
  double headroom_m = 5.0;     ///< height of the particles' domain above y = 0
  double support_ratio = 2.0;  ///< H / s
  double rest_density_kgpm3 = 1000.0;
  double sound_speed_mps = 14.0;  ///< c0; stiffness k = c0^2 in p = k (rho - rho0)
  double max_speed_mps = 8.0;     ///< U_max of the step-size rules; also the limit of the watchdog and the clamp
  double viscosity_pas = 60.0;    ///< dynamic viscosity mu
  double jitter_ratio = 0.02;     ///< initial jitter over s, 0..0.05
  KernelSet kernel_set = KernelSet::kWendlandC2;
  Boundary boundary_x = Boundary::kPeriodic;
  Boundary boundary_z = Boundary::kPeriodic;
  PressureSolver solver = PressureSolver::kWeaklyCompressible;
  EquationOfState equation_of_state = EquationOfState::kLinear;
  PressureForce pressure_force = PressureForce::kConserving;
  std::uint32_t iterations_count = 4;  ///< iterations of the position-based solver per substep
  bool cohesion = false;               ///< pressure may be negative
  double fill_x_ratio = 1.0;           ///< share of the domain along x that the lattice fills, from the -x side
  double fill_z_ratio = 1.0;
  double settle_s = 0.0;     ///< simulated time in which the initial lattice settles before the first tick
  double box_width_m = 0.0;  ///< side along z of the box when the scene has no wave; 0 = box_side_m
  /// A box without floor, surface and gravity: particles that leave through the top enter at the bottom. `layers_count`
  /// layers thick.
  bool periodic_y = false;
  double fill_density_ratio =
      1.0;  ///< density of the initial lattice over rest_density_kgpm3; other than 1 only with periodic_y
};

/// kOneWay: the wave carries a band of particles. kTwoWay: breaking water becomes particles, which later return to it.
enum class CouplingMode { kOneWay, kTwoWay };

/// What the particle patch follows.
enum class PatchFollow { kNothing, kEvent, kBoat };

struct CouplingScene {
  CouplingMode mode = CouplingMode::kOneWay;
  PatchFollow patch_follow = PatchFollow::kNothing;
  double emission_ratio = 1.0;      ///< two-way: factor on the amount of water that breaking emits
  double droplet_spacing_m = 0.1;   ///< two-way: edge of the cube of water that one particle holds
  std::uint32_t lattice_count = 3;  ///< virtual particles along a side of the lattice: 3 or 5
  double downforce_per_m_s2 = 1.5;  ///< downward acceleration = downforce * (height above the water)^2
};

/// White water, generated where the particle density is low.
struct FoamScene {
  double density_deficit_ratio = 0.25;  ///< 1 - rho/rho0 at which a particle is pure foam
  double lifetime_s = 1.5;              ///< e-folding time of a particle's foam after its source has ended
  std::uint32_t neighbours_count = 6;   ///< particles with fewer neighbours than this are foam; 0 = off
  bool surface = false;                 ///< a foam field on the surface, with an e-folding time per source:
  double breaking_lifetime_s = 6.0;
  double wake_lifetime_s = 8.0;
  double landing_lifetime_s = 3.0;
};

/// Boats on the wave.
struct BoatsScene {
  std::uint32_t capacity_count = 8;  ///< at most kMaxBoats
  std::vector<Boat> boats;           ///< present from the start; ids 1, 2, ...
};

/// Rain drops and wind waves.
struct StormScene {
  double level_ratio = 0.0;  ///< 0 calm .. 1 storm
  double drops_per_m2_s = 0.08;
  double drop_depth_m = 0.06;
  double wave_height_m = 0.3;
  double wind_direction_deg = 180.0;
};

/// Settings of the frames sent to clients.
struct StreamScene {
  double frame_rate_hz = 30.0;       ///< frames per wall second, at any simulation speed
  double surface_quantum_m = 0.001;  ///< elevation quantum
};

/// An effect that the scene starts at a simulation time.
struct TimedEvent {
  double at_s = 0.0;
  double every_s = 0.0;  ///< repeats with this period; 0 = once
  Effect effect;
};

struct Scene {
  std::string name;
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  double gravity_mps2 = 9.81;
  double tick_rate_hz = 60.0;              ///< commands are applied at ticks; substeps follow from derive()
  std::uint32_t fixed_substeps_count = 0;  ///< 0 = derive() chooses; otherwise this many substeps per tick, checked
  bool allow_unstable = false;             ///< skip the step-size rules (for stability studies)
  std::optional<WaveScene> wave;           ///< absent parts cost nothing
  std::optional<ParticleScene> particles;
  std::optional<CouplingScene> coupling;  ///< needs wave and particles
  std::optional<FoamScene> foam;          ///< needs particles, or a wave if it has a surface field
  std::vector<Obstacle> obstacles;        ///< need a wave
  std::vector<Beach> beaches;             ///< need a wave
  std::optional<BoatsScene> boats;        ///< on the wave, or among particles without a wave
  std::optional<StormScene> storm;        ///< needs a wave
  StreamScene stream;
  std::vector<TimedEvent> events;
};

}  // namespace spindrift::core
