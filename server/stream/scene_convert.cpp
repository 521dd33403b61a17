// Proto to core, field for field.
#include <spindrift/stream/scene_loader.h>

#include "fields.h"
#include "scene_rules.h"

namespace spindrift::stream {
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

core::Side toCore(v1::Side side) {
  switch (side) {
    case v1::SIDE_MINUS_X:
      return core::Side::kMinusX;
    case v1::SIDE_PLUS_Z:
      return core::Side::kPlusZ;
    case v1::SIDE_MINUS_Z:
      return core::Side::kMinusZ;
    default:
      return core::Side::kPlusX;
  }
}

core::WaveScene toCore(const v1::WaveScene& in) {
  core::WaveScene out;
  out.resolution_count = in.resolution_count();
  out.side_m = in.side_m();
  out.depth_m = in.depth_m();
  out.damping_per_s = in.damping_per_s();
  out.stencil = toCore(in.stencil());
  out.boundary_minus_x = toCore(in.boundary_minus_x());
  out.boundary_plus_x = toCore(in.boundary_plus_x());
  out.boundary_minus_z = toCore(in.boundary_minus_z());
  out.boundary_plus_z = toCore(in.boundary_plus_z());
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
  return out;
}

core::TimedEvent toCore(const v1::TimedEvent& in) {
  core::TimedEvent out;
  out.at_s = in.at_s();
  out.every_s = in.every_s();
  if (in.effect().has_breaking_wave()) {
    out.effect = stream::toCore(in.effect().breaking_wave());
  } else {
    out.effect = stream::toCore(in.effect().splash());
  }
  return out;
}

}  // namespace

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
  out.side = toCore(in.side());
  out.amplitude_m = in.amplitude_m();
  out.length_m = in.length_m();
  out.duration_s = in.duration_s();
  return out;
}

void fillDefaults(v1::Scene& scene) {
  scene.mutable_stream();
  if (scene.seed() == 0) scene.set_seed(1);
  fillMessageDefaults(scene);
}

core::Scene toCore(const v1::Scene& scene) {
  v1::Scene in = scene;
  fillDefaults(in);
  core::Scene out;
  out.name = in.name();
  out.title = in.title();
  out.description = in.description();
  out.seed = in.seed();
  out.gravity_mps2 = in.gravity_mps2();
  out.tick_rate_hz = in.tick_rate_hz();
  out.fixed_substeps_count = in.fixed_substeps_count();
  out.allow_unstable = in.allow_unstable();
  if (in.has_wave()) out.wave = toCore(in.wave());
  if (in.has_particles()) out.particles = toCore(in.particles());
  if (in.has_coupling()) {
    out.coupling = core::CouplingScene{in.coupling().lattice_count(), in.coupling().downforce_per_m_s2()};
  }
  if (in.has_foam()) out.foam = core::FoamScene{in.foam().density_deficit_ratio(), in.foam().lifetime_s()};
  out.stream.frame_rate_hz = in.stream().frame_rate_hz();
  out.stream.surface_quantum_m = in.stream().surface_quantum_m();
  for (const v1::TimedEvent& event : in.events()) out.events.push_back(toCore(event));
  return out;
}

}  // namespace spindrift::stream
