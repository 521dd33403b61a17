// Proto to core, field for field.
#include <cstring>
#include <memory>

#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

#include "wave_makers.h"

namespace spindrift::scene {
namespace {

core::Boundary toCore(v1::Boundary boundary) {
  return boundary == v1::BOUNDARY_WALL ? core::Boundary::kWall : core::Boundary::kPeriodic;
}

core::WaveBoundary toCore(v1::WaveBoundary boundary) {
  switch (boundary) {
    case v1::WAVE_BOUNDARY_REFLECT:
      return core::WaveBoundary::kReflect;
    case v1::WAVE_BOUNDARY_ABSORB:
      return core::WaveBoundary::kAbsorb;
    default:
      return core::WaveBoundary::kPeriodic;
  }
}

core::KernelSet toCore(v1::KernelSet set) {
  switch (set) {
    case v1::KERNEL_SET_MULLER:
      return core::KernelSet::kMuller;
    case v1::KERNEL_SET_CUBIC_SPLINE:
      return core::KernelSet::kCubicSpline;
    default:
      return core::KernelSet::kWendlandC2;
  }
}

core::Stencil toCore(v1::Stencil stencil) {
  return stencil == v1::STENCIL_NINE_POINT ? core::Stencil::kNinePoint : core::Stencil::kFivePoint;
}

core::Bulk toCore(v1::Bulk bulk) {
  return bulk == v1::BULK_NONLINEAR ? core::Bulk::kNonlinear : core::Bulk::kLinear;
}

core::Absorption toCore(v1::Absorption absorption) {
  switch (absorption) {
    case v1::ABSORPTION_SPONGE:
      return core::Absorption::kSponge;
    case v1::ABSORPTION_PML:
      return core::Absorption::kPml;
    default:
      return core::Absorption::kByStencil;
  }
}

core::Dispersion toCore(v1::Dispersion dispersion) {
  return dispersion == v1::DISPERSION_AIRY ? core::Dispersion::kAiry : core::Dispersion::kNone;
}

core::WaveShape toCore(v1::WaveShape shape) {
  return shape == v1::WAVE_SHAPE_SWELL ? core::WaveShape::kSwell : core::WaveShape::kBreaking;
}

core::PressureSolver toCore(v1::PressureSolver solver) {
  return solver == v1::PRESSURE_SOLVER_POSITION_BASED ? core::PressureSolver::kPositionBased
                                                      : core::PressureSolver::kWeaklyCompressible;
}

core::EquationOfState toCore(v1::EquationOfState equation) {
  return equation == v1::EQUATION_OF_STATE_TAIT ? core::EquationOfState::kTait : core::EquationOfState::kLinear;
}

core::PressureForce toCore(v1::PressureForce force) {
  return force == v1::PRESSURE_FORCE_MEAN ? core::PressureForce::kMean : core::PressureForce::kConserving;
}

core::CouplingMode toCore(v1::CouplingMode mode) {
  return mode == v1::COUPLING_MODE_TWO_WAY ? core::CouplingMode::kTwoWay : core::CouplingMode::kOneWay;
}

core::PatchFollow toCore(v1::PatchFollow follow) {
  switch (follow) {
    case v1::PATCH_FOLLOW_EVENT:
      return core::PatchFollow::kEvent;
    case v1::PATCH_FOLLOW_BOAT:
      return core::PatchFollow::kBoat;
    default:
      return core::PatchFollow::kNothing;
  }
}

core::WaveScene toCore(const v1::WaveScene& in) {
  core::WaveScene out;
  out.resolution_count = in.resolution_count();
  out.side_m = in.side_m();
  out.width_m = in.width_m();
  out.depth_m = in.depth_m();
  out.damping_per_s = in.damping_per_s();
  out.stencil = toCore(in.stencil());
  out.dispersion = toCore(in.dispersion());
  out.absorption = toCore(in.absorption());
  out.bulk = toCore(in.bulk());
  out.manning_spm13 = in.manning_spm13();
  out.boundary_minus_x = toCore(in.boundary_minus_x());
  out.boundary_plus_x = toCore(in.boundary_plus_x());
  out.boundary_minus_z = toCore(in.boundary_minus_z());
  out.boundary_plus_z = toCore(in.boundary_plus_z());
  out.sponge_width_m = in.sponge_width_m();
  out.steepening_ratio = in.steepening_ratio();
  out.fixed_substeps_count = in.fixed_substeps_count();
  return out;
}

core::ParticleScene toCore(const v1::ParticleScene& in) {
  core::ParticleScene out;
  out.count = in.count();
  out.layers_count = in.layers_count();
  out.patch_shift_x_m = in.patch_shift_x_m();
  out.patch_shift_z_m = in.patch_shift_z_m();
  out.patch_scale = in.patch_scale();
  out.box_side_m = in.box_side_m();
  out.headroom_m = in.headroom_m();
  out.support_ratio = in.support_ratio();
  out.rest_density_kgpm3 = in.rest_density_kgpm3();
  out.sound_speed_mps = in.sound_speed_mps();
  out.max_speed_mps = in.max_speed_mps();
  out.viscosity_pas = in.viscosity_pas();
  out.jitter_ratio = in.jitter_ratio();
  out.kernel_set = toCore(in.kernel_set());
  out.boundary_x = toCore(in.boundary_x());
  out.boundary_z = toCore(in.boundary_z());
  out.solver = toCore(in.solver());
  out.equation_of_state = toCore(in.equation_of_state());
  out.pressure_force = toCore(in.pressure_force());
  out.iterations_count = in.iterations_count();
  out.cohesion = in.cohesion();
  out.fill_x_ratio = in.fill_x_ratio();
  out.fill_z_ratio = in.fill_z_ratio();
  out.box_width_m = in.box_width_m();
  out.settle_s = in.settle_s();
  out.periodic_y = in.periodic_y();
  out.fill_density_ratio = in.fill_density_ratio();
  return out;
}

core::CouplingScene toCore(const v1::CouplingScene& in) {
  core::CouplingScene out;
  out.mode = toCore(in.mode());
  out.patch_follow = toCore(in.patch_follow());
  out.emission_ratio = in.emission_ratio();
  out.droplet_spacing_m = in.droplet_spacing_m();
  out.lattice_count = in.lattice_count();
  out.downforce_per_m_s2 = in.downforce_per_m_s2();
  return out;
}

core::FoamScene toCore(const v1::FoamScene& in) {
  core::FoamScene out;
  out.density_deficit_ratio = in.density_deficit_ratio();
  out.lifetime_s = in.lifetime_s();
  out.neighbours_count = in.neighbours_count();
  out.surface = in.surface();
  out.breaking_lifetime_s = in.breaking_lifetime_s();
  out.wake_lifetime_s = in.wake_lifetime_s();
  out.landing_lifetime_s = in.landing_lifetime_s();
  return out;
}

core::Obstacle toCore(const v1::Obstacle& in) {
  if (in.has_breakwater()) {
    const v1::Breakwater& wall = in.breakwater();
    return core::Breakwater{.x_m = wall.x_m(),
                            .z_m = wall.z_m(),
                            .length_m = wall.length_m(),
                            .width_m = wall.width_m(),
                            .heading_deg = wall.heading_deg(),
                            .height_m = wall.height_m()};
  }
  v1::Rock rock = in.rock();
  fillMessageDefaults(rock);
  return core::Rock{.x_m = rock.x_m(), .z_m = rock.z_m(), .radius_m = rock.radius_m(), .height_m = rock.height_m()};
}

core::Beach toCore(const v1::Beach& in) {
  return {.side = scene::toCore(in.side()), .width_m = in.width_m(), .shore_depth_m = in.shore_depth_m()};
}

core::DepthGrid toCore(const v1::DepthGrid& in) {
  core::DepthGrid out;
  out.x_m = in.x_m();
  out.z_m = in.z_m();
  out.length_m = in.length_m();
  out.width_m = in.width_m();
  const std::size_t row_bytes = in.points_size() > 0 ? in.points(0).size() : 0;
  out.columns_count = static_cast<std::uint32_t>(row_bytes / sizeof(float));
  out.rows_count = static_cast<std::uint32_t>(in.points_size());
  // derive() refuses a grid whose rows differ: it has fewer depths than points.
  std::vector<float> depths_m;
  for (const std::string& row : in.points()) {
    if (row.size() != row_bytes) break;
    const std::size_t before = depths_m.size();
    depths_m.resize(before + out.columns_count);
    std::memcpy(depths_m.data() + before, row.data(), out.columns_count * sizeof(float));
  }
  out.depths_m = std::make_shared<const std::vector<float>>(std::move(depths_m));
  return out;
}

core::BedShape toCore(const v1::BedShape& in) {
  if (in.has_slope()) {
    const v1::BedSlope& slope = in.slope();
    return core::BedSlope{.x_m = slope.x_m(),
                          .z_m = slope.z_m(),
                          .heading_deg = slope.heading_deg(),
                          .gradient_ratio = slope.gradient_ratio(),
                          .length_m = slope.length_m()};
  }
  if (in.has_sill()) {
    const v1::BedSill& sill = in.sill();
    return core::BedSill{.x_m = sill.x_m(),
                         .z_m = sill.z_m(),
                         .heading_deg = sill.heading_deg(),
                         .length_m = sill.length_m(),
                         .crest_width_m = sill.crest_width_m(),
                         .flank_width_m = sill.flank_width_m(),
                         .height_m = sill.height_m()};
  }
  if (in.has_channel()) {
    const v1::BedChannel& channel = in.channel();
    return core::BedChannel{.x_m = channel.x_m(),
                            .z_m = channel.z_m(),
                            .heading_deg = channel.heading_deg(),
                            .length_m = channel.length_m(),
                            .bottom_width_m = channel.bottom_width_m(),
                            .bank_width_m = channel.bank_width_m(),
                            .cut_m = channel.cut_m()};
  }
  v1::BedCone cone = in.cone();
  fillMessageDefaults(cone);
  return core::BedCone{.x_m = cone.x_m(),
                       .z_m = cone.z_m(),
                       .toe_radius_m = cone.toe_radius_m(),
                       .crest_radius_m = cone.crest_radius_m(),
                       .height_m = cone.height_m()};
}

core::Bed toCore(const v1::Bed& in) {
  core::Bed out;
  out.floor_depth_m = in.floor_depth_m();
  if (in.has_grid()) out.grid = toCore(in.grid());
  for (const v1::BedShape& shape : in.shapes()) out.shapes.push_back(toCore(shape));
  return out;
}

core::StormScene toCore(const v1::StormScene& in) {
  core::StormScene out;
  out.level_ratio = in.level_ratio();
  out.drops_per_m2_s = in.drops_per_m2_s();
  out.drop_depth_m = in.drop_depth_m();
  out.wave_height_m = in.wave_height_m();
  out.wind_direction_deg = in.wind_direction_deg();
  out.wind_speed_mps = in.wind_speed_mps();
  out.fetch_m = in.fetch_m();
  return out;
}

core::BoatsScene toCore(const v1::BoatsScene& in) {
  core::BoatsScene out;
  out.capacity_count = in.capacity_count();
  for (const v1::Boat& boat : in.boats()) out.boats.push_back(scene::toCore(boat));
  return out;
}

core::TimedEvent toCore(const v1::TimedEvent& in) {
  core::TimedEvent out;
  out.at_s = in.at_s();
  out.every_s = in.every_s();
  if (in.effect().has_breaking_wave()) {
    out.effect = scene::toCore(in.effect().breaking_wave());
  } else {
    out.effect = scene::toCore(in.effect().splash());
  }
  return out;
}

}  // namespace

core::Side toCore(v1::Side side) {
  switch (side) {
    case v1::SIDE_MINUS_X:
      return core::Side::kMinusX;
    case v1::SIDE_PLUS_Z:
      return core::Side::kPlusZ;
    case v1::SIDE_MINUS_Z:
      return core::Side::kMinusZ;
    case v1::SIDE_DIRECTION:
      return core::Side::kDirection;
    default:
      return core::Side::kPlusX;
  }
}

core::Splash toCore(const v1::Splash& splash) {
  v1::Splash in = splash;
  fillMessageDefaults(in);
  core::Splash out;
  out.x_m = in.x_m();
  out.z_m = in.z_m();
  out.radius_m = in.radius_m();
  out.depth_m = in.depth_m();
  out.duration_s = in.duration_s();
  return out;
}

core::BreakingWave toCore(const v1::BreakingWave& wave) {
  v1::BreakingWave in = wave;
  fillMessageDefaults(in);
  core::BreakingWave out;
  if (in.side() != v1::SIDE_UNSPECIFIED) out.side = toCore(in.side());
  out.amplitude_m = in.amplitude_m();
  out.length_m = in.length_m();
  out.duration_s = in.duration_s();
  out.shape = toCore(in.shape());
  out.direction_deg = in.direction_deg();
  return out;
}

core::Boat toCore(const v1::Boat& boat) {
  v1::Boat in = boat;
  fillMessageDefaults(in);
  core::Boat out;
  out.x_m = in.x_m();
  out.z_m = in.z_m();
  out.heading_deg = in.heading_deg();
  out.length_m = in.length_m();
  out.beam_m = in.beam_m();
  out.height_m = in.height_m();
  out.density_ratio = in.density_ratio();
  out.max_speed_mps = in.max_speed_mps();
  out.throttle_ratio = in.throttle_ratio();
  out.rudder_ratio = in.rudder_ratio();
  return out;
}

core::Scene toCore(const v1::Scene& scene) {
  v1::Scene in = scene;
  fillDefaults(in);
  core::Scene out;
  out.name = in.name();
  out.title = in.title();
  out.description = in.description();
  out.seed = in.seed();
  // Below this, waves need hours to cross any water, and numbers that follow from their speed leave the range of
  // floats.
  constexpr double kLeastGravity_mps2 = 1e-6;
  out.gravity_mps2 = in.gravity_mps2() < kLeastGravity_mps2 ? 0.0 : in.gravity_mps2();
  out.tick_rate_hz = in.tick_rate_hz();
  out.fixed_substeps_count = in.fixed_substeps_count();
  out.allow_unstable = in.allow_unstable();
  if (in.has_wave()) out.wave = toCore(in.wave());
  if (in.has_particles()) out.particles = toCore(in.particles());
  if (in.has_coupling()) out.coupling = toCore(in.coupling());
  if (in.has_foam()) out.foam = toCore(in.foam());
  for (const v1::Obstacle& obstacle : in.obstacles()) out.obstacles.push_back(toCore(obstacle));
  for (const v1::Beach& beach : in.beaches()) out.beaches.push_back(toCore(beach));
  if (in.has_bed()) out.bed = toCore(in.bed());
  for (const v1::Gauge& gauge : in.gauges())
    out.gauges.push_back({.name = gauge.name(), .x_m = gauge.x_m(), .z_m = gauge.z_m()});
  for (const v1::WaveMaker& maker : in.wave_makers()) out.wave_makers.push_back(toCore(maker));
  if (in.has_boats()) out.boats = toCore(in.boats());
  if (in.has_storm()) out.storm = toCore(in.storm());
  out.stream.frame_rate_hz = in.stream().frame_rate_hz();
  out.stream.surface_quantum_m = in.stream().surface_quantum_m();
  for (const v1::TimedEvent& event : in.events()) out.events.push_back(toCore(event));
  return out;
}

}  // namespace spindrift::scene
