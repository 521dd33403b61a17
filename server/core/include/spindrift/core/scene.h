// The scene as the simulation reads it: plain values in SI units, already validated against the ranges in proto.
// The scene module fills it from scene.proto (same fields, same names); sim::derive() computes step sizes and layouts.
// Axes: right-handed, y up, rest water level y = 0, domain centred on the origin, x and z horizontal.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <spindrift/core/cell_counts.h>
#include <spindrift/core/effect.h>
#include <spindrift/core/scene_defaults.h>

namespace spindrift::core {

/// What happens to particles at a pair of opposite sides.
enum class Boundary { kPeriodic, kWall };

/// What happens to waves at a side. Periodic sides come in pairs.
enum class WaveBoundary { kPeriodic, kReflect, kAbsorb };

/// 5-point or isotropic 9-point Laplacian of the wave equation.
enum class Stencil { kFivePoint, kNinePoint };

/// kNone: all waves travel at sqrt(g d). kAiry: omega^2 = g k tanh(k d).
enum class Dispersion { kNone, kAiry };

/// kLinear: small waves on still water; the shore does not move. kNonlinear: shallow water of real depth with wetting
/// and drying.
enum class Bulk { kLinear, kNonlinear };

/// What the layer along absorbing sides is. kByStencil: kPml with the 5-point stencil, kSponge with the 9-point one.
enum class Absorption { kByStencil, kSponge, kPml };

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
  using Default = defaults::WaveScene;
  std::uint32_t resolution_count = Default::resolution_count;  ///< cells along x
  double side_m = Default::side_m;                             ///< extent along x
  double width_m = Default::width_m;                           ///< extent along z, in whole cells; 0 = side_m
  double depth_m = Default::depth_m;                           ///< still-water depth d
  double damping_per_s = Default::damping_per_s;               ///< kappa, on the velocity term only
  Stencil stencil = Stencil::kFivePoint;
  WaveBoundary boundary_minus_x = WaveBoundary::kPeriodic;
  WaveBoundary boundary_plus_x = WaveBoundary::kPeriodic;
  WaveBoundary boundary_minus_z = WaveBoundary::kPeriodic;
  WaveBoundary boundary_plus_z = WaveBoundary::kPeriodic;
  [[nodiscard]] WaveCells cells() const { return waveCellsOf(resolution_count, side_m, width_m); }
  /// Sets all four sides.
  void setBoundaries(WaveBoundary all) {
    boundary_minus_x = boundary_plus_x = boundary_minus_z = boundary_plus_z = all;
  }
  double sponge_width_m = Default::sponge_width_m;  ///< width of the absorbing layer along a side
  double steepening_ratio =
      Default::steepening_ratio;  ///< 0: linear waves; 1: speed follows the local water depth (shallow water)
  std::uint32_t fixed_substeps_count =
      Default::fixed_substeps_count;  ///< 0 = derive() chooses; otherwise this many wave steps per tick, checked
  Dispersion dispersion = Dispersion::kNone;
  Absorption absorption = Absorption::kByStencil;
  Bulk bulk = Bulk::kLinear;
  double manning_spm13 = Default::manning_spm13;  ///< roughness of the bed, nonlinear bulk only [s/m^(1/3)]

  bool operator==(const WaveScene&) const = default;
};

/// A round rock that stands out of the water.
struct Rock {
  using Default = defaults::Rock;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double radius_m = Default::radius_m;
  double height_m = Default::height_m;  ///< above the still water

  bool operator==(const Rock&) const = default;
};

/// A straight wall from the bed to above the water. Heading 0 runs along x and turns from +x toward +z.
struct Breakwater {
  using Default = defaults::Breakwater;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double length_m = Default::length_m;
  double width_m = Default::width_m;
  double heading_deg = Default::heading_deg;
  double height_m = Default::height_m;

  bool operator==(const Breakwater&) const = default;
};

using Obstacle = std::variant<Rock, Breakwater>;

/// The bed rises linearly over width_m toward a side, from the depth of the floor to shore_depth_m at the side; below 0
/// it is land.
struct Beach {
  using Default = defaults::Beach;
  Side side = Side::kPlusX;
  double width_m = Default::width_m;
  double shore_depth_m = Default::shore_depth_m;

  bool operator==(const Beach&) const = default;
};

/// Depths at the points of a grid over a rectangle, bilinear between them. [m], negative on land
struct DepthGrid {
  using Default = defaults::DepthGrid;
  double x_m = Default::x_m;  ///< centre
  double z_m = Default::z_m;
  double length_m = Default::length_m;  ///< first to last point along x; 0 = the length of the water
  double width_m = Default::width_m;    ///< the same along z
  std::uint32_t columns_count = 0;      ///< points along x
  std::uint32_t rows_count = 0;
  /// columns_count * rows_count, x fastest. Shared by the copies of a scene.
  std::shared_ptr<const std::vector<float>> depths_m;

  bool operator==(const DepthGrid& other) const {
    return x_m == other.x_m && z_m == other.z_m && length_m == other.length_m && width_m == other.width_m &&
           columns_count == other.columns_count && rows_count == other.rows_count &&
           (depths_m == other.depths_m || (depths_m && other.depths_m && *depths_m == *other.depths_m));
  }
};

/// A truncated cone, height_m over the bed on which it stands; negative for a pit.
struct BedCone {
  using Default = defaults::BedCone;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double toe_radius_m = Default::toe_radius_m;
  double crest_radius_m = Default::crest_radius_m;
  double height_m = Default::height_m;

  bool operator==(const BedCone&) const = default;
};

/// A plane that rises from a line through (x_m, z_m) toward heading_deg, for length_m (0: to the sides).
struct BedSlope {
  using Default = defaults::BedSlope;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double heading_deg = Default::heading_deg;
  double gradient_ratio = Default::gradient_ratio;
  double length_m = Default::length_m;

  bool operator==(const BedSlope&) const = default;
};

/// A bar with a level crest and flanks all round, height_m over the bed.
struct BedSill {
  using Default = defaults::BedSill;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double heading_deg = Default::heading_deg;
  double length_m = Default::length_m;
  double crest_width_m = Default::crest_width_m;
  double flank_width_m = Default::flank_width_m;
  double height_m = Default::height_m;

  bool operator==(const BedSill&) const = default;
};

/// A trench with a level bottom and banks all round, cut_m below the bed.
struct BedChannel {
  using Default = defaults::BedChannel;
  double x_m = Default::x_m;
  double z_m = Default::z_m;
  double heading_deg = Default::heading_deg;
  double length_m = Default::length_m;
  double bottom_width_m = Default::bottom_width_m;
  double bank_width_m = Default::bank_width_m;
  double cut_m = Default::cut_m;

  bool operator==(const BedChannel&) const = default;
};

using BedShape = std::variant<BedCone, BedSlope, BedSill, BedChannel>;

/// The bed: level floor, beaches, grid, then the shapes in order (sim_setup/ground.h).
struct Bed {
  using Default = defaults::Bed;
  double floor_depth_m = Default::floor_depth_m;  ///< 0 = the depth of the water
  std::optional<DepthGrid> grid;
  std::vector<BedShape> shapes;

  bool operator==(const Bed&) const = default;
};

/// A place where elevation and velocity are measured at every tick.
struct Gauge {
  using Default = defaults::Gauge;
  std::string name;
  double x_m = Default::x_m;
  double z_m = Default::z_m;

  bool operator==(const Gauge&) const = default;
};

/// At most this many gauges in a scene.
inline constexpr std::uint32_t kMaxGauges = 64;

/// Waves of one height (trough to crest) and one period.
struct RegularWaves {
  using Default = defaults::RegularWaves;
  double height_m = Default::height_m;
  double period_s = Default::period_s;

  bool operator==(const RegularWaves&) const = default;
};

/// A JONSWAP spectrum as a sum of waves with random phases.
struct IrregularWaves {
  using Default = defaults::IrregularWaves;
  double significant_height_m = Default::significant_height_m;
  double peak_period_s = Default::peak_period_s;
  double peak_enhancement_ratio = Default::peak_enhancement_ratio;
  std::uint32_t waves_count = Default::waves_count;
  std::uint64_t seed = 0;  ///< 0 = that of the scene

  bool operator==(const IrregularWaves&) const = default;
};

/// One crest of permanent form.
struct SolitaryWave {
  using Default = defaults::SolitaryWave;
  double height_m = Default::height_m;

  bool operator==(const SolitaryWave&) const = default;
};

/// An elevation over time: as many numbers in both lists, times increasing. Level before and after.
struct ElevationSeries {
  std::vector<double> time_s;
  std::vector<double> elevation_m;

  bool operator==(const ElevationSeries&) const = default;
};

/// Makes waves along a side, which is a wall otherwise, and takes up those that come back (sim_setup/incident_waves.h).
struct WaveMaker {
  using Default = defaults::WaveMaker;
  Side side = Side::kPlusX;
  double begin_s = Default::begin_s;
  double duration_s = Default::duration_s;  ///< of regular and irregular waves; 0 = without end
  std::variant<RegularWaves, IrregularWaves, SolitaryWave, ElevationSeries> waves;

  bool operator==(const WaveMaker&) const = default;
};

/// The SPH particles of a patch: a band of water, `layers` spacings thick, over part of the surface or all of it.
struct ParticleScene {
  using Default = defaults::ParticleScene;
  std::uint32_t count = Default::count;  ///< wanted particles; derive() rounds to a full lattice and reports the result
  double layers_count = Default::layers_count;        ///< thickness of the resting band in particle spacings
  double patch_shift_x_m = Default::patch_shift_x_m;  ///< patch centre
  double patch_shift_z_m = Default::patch_shift_z_m;
  double patch_scale = Default::patch_scale;      ///< patch over water, along x and along z; 0..1
  double box_side_m = Default::box_side_m;        ///< side of the horizontal box when the scene has no wave
  double headroom_m = Default::headroom_m;        ///< height of the particles' domain above y = 0
  double support_ratio = Default::support_ratio;  ///< H / s
  double rest_density_kgpm3 = Default::rest_density_kgpm3;
  double sound_speed_mps = Default::sound_speed_mps;  ///< c0; stiffness k = c0^2 in p = k (rho - rho0)
  double max_speed_mps =
      Default::max_speed_mps;  ///< U_max of the step-size rules; also the limit of the watchdog and the clamp
  double viscosity_pas = Default::viscosity_pas;  ///< dynamic viscosity mu
  double jitter_ratio = Default::jitter_ratio;    ///< initial jitter over s, 0..0.05
  KernelSet kernel_set = KernelSet::kWendlandC2;
  Boundary boundary_x = Boundary::kPeriodic;
  Boundary boundary_z = Boundary::kPeriodic;
  PressureSolver solver = PressureSolver::kWeaklyCompressible;
  EquationOfState equation_of_state = EquationOfState::kLinear;
  PressureForce pressure_force = PressureForce::kConserving;
  std::uint32_t iterations_count = Default::iterations_count;  ///< iterations of the position-based solver per substep
  bool cohesion = false;                                       ///< pressure may be negative
  double fill_x_ratio =
      Default::fill_x_ratio;  ///< share of the domain along x that the lattice fills, from the -x side
  double fill_z_ratio = Default::fill_z_ratio;
  double settle_s = Default::settle_s;  ///< simulated time in which the initial lattice settles before the first tick
  double box_width_m = Default::box_width_m;  ///< side along z of the box when the scene has no wave; 0 = box_side_m
  /// A box without floor, surface and gravity: particles that leave through the top enter at the bottom. `layers_count`
  /// layers thick.
  bool periodic_y = false;
  double fill_density_ratio = Default::fill_density_ratio;  ///< density of the initial lattice over rest_density_kgpm3;
                                                            ///< other than 1 only with periodic_y
};

/// kOneWay: the wave carries a band of particles. kTwoWay: breaking water becomes particles, which later return to it.
enum class CouplingMode { kOneWay, kTwoWay };

/// What the particle patch follows.
enum class PatchFollow { kNothing, kEvent, kBoat };

struct CouplingScene {
  using Default = defaults::CouplingScene;
  CouplingMode mode = CouplingMode::kOneWay;
  PatchFollow patch_follow = PatchFollow::kNothing;
  double emission_ratio = Default::emission_ratio;  ///< two-way: factor on the amount of water that breaking emits
  double droplet_spacing_m =
      Default::droplet_spacing_m;                        ///< two-way: edge of the cube of water that one particle holds
  std::uint32_t lattice_count = Default::lattice_count;  ///< virtual particles along a side of the lattice: 3 or 5
  double downforce_per_m_s2 =
      Default::downforce_per_m_s2;  ///< downward acceleration = downforce * (height above the water)^2
};

/// White water, generated where the particle density is low.
struct FoamScene {
  using Default = defaults::FoamScene;
  double density_deficit_ratio = Default::density_deficit_ratio;  ///< 1 - rho/rho0 at which a particle is pure foam
  double lifetime_s = Default::lifetime_s;  ///< e-folding time of a particle's foam after its source has ended
  std::uint32_t neighbours_count =
      Default::neighbours_count;  ///< particles with fewer neighbours than this are foam; 0 = off
  bool surface = false;           ///< a foam field on the surface, with an e-folding time per source:
  double breaking_lifetime_s = Default::breaking_lifetime_s;
  double wake_lifetime_s = Default::wake_lifetime_s;
  double landing_lifetime_s = Default::landing_lifetime_s;
};

/// Boats on the wave.
struct BoatsScene {
  using Default = defaults::BoatsScene;
  std::uint32_t capacity_count = Default::capacity_count;  ///< at most kMaxBoats
  std::vector<Boat> boats;                                 ///< present from the start; ids 1, 2, ...
};

/// Rain drops and wind waves.
struct StormScene {
  using Default = defaults::StormScene;
  double level_ratio = Default::level_ratio;  ///< 0 calm .. 1 storm
  double drops_per_m2_s = Default::drops_per_m2_s;
  double drop_depth_m = Default::drop_depth_m;
  double wave_height_m = Default::wave_height_m;
  double wind_direction_deg = Default::wind_direction_deg;
  double wind_speed_mps = Default::wind_speed_mps;  ///< at level 1
  double fetch_m = Default::fetch_m;                ///< length of the water that the wind has crossed
};

/// Settings of the frames sent to clients.
struct StreamScene {
  using Default = defaults::StreamScene;
  double frame_rate_hz = Default::frame_rate_hz;          ///< frames per wall second, at any simulation speed
  double surface_quantum_m = Default::surface_quantum_m;  ///< elevation quantum
};

/// An effect that the scene starts at a simulation time.
struct TimedEvent {
  using Default = defaults::TimedEvent;
  double at_s = Default::at_s;
  double every_s = Default::every_s;  ///< repeats with this period; 0 = once
  Effect effect;
};

struct Scene {
  using Default = defaults::Scene;
  std::string name;
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  double gravity_mps2 = Default::gravity_mps2;
  double tick_rate_hz = Default::tick_rate_hz;  ///< commands are applied at ticks; substeps follow from derive()
  std::uint32_t fixed_substeps_count =
      Default::fixed_substeps_count;  ///< 0 = derive() chooses; otherwise this many substeps per tick, checked
  bool allow_unstable = false;        ///< skip the step-size rules (for stability studies)
  std::optional<WaveScene> wave;      ///< absent parts cost nothing
  std::optional<ParticleScene> particles;
  std::optional<CouplingScene> coupling;  ///< needs wave and particles
  std::optional<FoamScene> foam;          ///< needs particles, or a wave if it has a surface field
  std::vector<Obstacle> obstacles;        ///< need a wave
  std::vector<Beach> beaches;             ///< need a wave
  std::optional<Bed> bed;                 ///< needs a wave
  std::vector<Gauge> gauges;              ///< need a wave
  std::vector<WaveMaker> wave_makers;     ///< need a wave; at most one a side
  std::optional<BoatsScene> boats;        ///< on the wave, or among particles without a wave
  std::optional<StormScene> storm;        ///< needs a wave
  StreamScene stream;
  std::vector<TimedEvent> events;
};

}  // namespace spindrift::core
