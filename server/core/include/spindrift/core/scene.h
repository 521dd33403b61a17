// The scene as the simulation sees it: plain values in SI units, already validated against the ranges in proto.
// stream fills it from scene.proto (field for field, same names); sim::derive() turns it into step sizes and layouts.
// Axes: right-handed, y up, rest water level y = 0, domain centred on the origin, x and z horizontal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/command.h>

namespace spindrift::core {

/// What happens at a pair of opposite sides.
enum class Boundary { kPeriodic, kWall };

/// 5-point or isotropic 9-point Laplacian of the wave equation.
enum class Stencil { kFivePoint, kNinePoint };

/// Kernels for density and pressure. kMuller (poly6 and spiky) is the thesis's; its pressure is not the gradient
/// of its density. The others use one kernel for both, so that pressure neither makes nor takes energy.
enum class KernelSet { kMuller, kCubicSpline, kWendlandC2 };

/// The heightfield: eta_tt + kappa eta_t = c^2 laplacian(eta), c = sqrt(g d).
struct WaveScene {
  std::uint32_t resolution_count = 256;  ///< cells along each side (x and z), multiple of 16
  double side_m = 24.0;                  ///< side of the square domain
  double depth_m = 1.5;                  ///< still-water depth d
  double damping_per_s = 0.1;            ///< kappa, on the velocity term only
  Stencil stencil = Stencil::kFivePoint;
  Boundary boundary = Boundary::kPeriodic;  ///< all four sides
};

/// The SPH particles of a patch: a band of water, `layers` spacings thick, over part of the surface or all of it.
struct ParticleScene {
  std::uint32_t count = 8192;    ///< wanted particles; derive() rounds to a full lattice and reports the result
  double layers_count = 3.0;     ///< thickness of the resting band in particle spacings
  double patch_shift_x_m = 0.0;  ///< patch centre
  double patch_shift_z_m = 0.0;
  double patch_scale = 1.0;    ///< patch side over wave side (over `box_side_m` without a wave), 0..1
  double box_side_m = 24.0;    ///< side of the horizontal box when the scene has no wave
  double headroom_m = 5.0;     ///< the particles' domain reaches this far above y = 0
  double support_ratio = 2.0;  ///< H / s
  double rest_density_kgpm3 = 1000.0;
  double sound_speed_mps = 14.0;  ///< c0; stiffness k = c0^2 in p = k (rho - rho0)
  double max_speed_mps = 8.0;     ///< U_max for the step-size rules; also the guard's and the clamp's bound
  double viscosity_pas = 60.0;    ///< dynamic viscosity mu
  double jitter_ratio = 0.02;     ///< initial jitter over s, 0..0.05
  KernelSet kernel_set = KernelSet::kWendlandC2;
  Boundary boundary_x = Boundary::kPeriodic;
  Boundary boundary_z = Boundary::kPeriodic;
};

/// One-way coupling: the wave carries the particles.
struct CouplingScene {
  std::uint32_t lattice_count = 3;  ///< virtual particles along a side of the lattice: 3 or 5
  double downforce_per_m_s2 = 1.5;  ///< downward acceleration = downforce * (height above the water)^2
};

/// White water from low pressure.
struct FoamScene {
  double density_deficit_ratio = 0.25;  ///< 1 - rho/rho0 at which a particle is fully foam
  double lifetime_s = 1.5;              ///< e-folding time of foam once its source is gone
};

/// What a client is sent.
struct StreamScene {
  double frame_rate_hz = 30.0;       ///< frames per wall second, whatever the speed
  double surface_quantum_m = 0.001;  ///< elevation quantum
};

/// An effect that a scene starts by itself, at a simulation time.
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
  std::uint32_t fixed_substeps_count = 0;  ///< 0 = derive() chooses; otherwise this many substeps a tick, checked
  bool allow_unstable = false;             ///< skip the step-size rules (for stability studies)
  std::optional<WaveScene> wave;           ///< absent parts cost nothing
  std::optional<ParticleScene> particles;
  std::optional<CouplingScene> coupling;  ///< needs wave and particles
  std::optional<FoamScene> foam;          ///< needs particles
  StreamScene stream;
  std::vector<TimedEvent> events;
};

}  // namespace spindrift::core
