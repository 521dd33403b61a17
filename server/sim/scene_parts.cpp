#include "scene_parts.h"

#include <string>

#include "particle_buffers.h"

namespace spindrift::sim {
namespace {

using core::WaveBoundary;

/// Number of a kernel set in shaders/particles/kernels.glsl.
int kernelSetNumber(core::KernelSet set) {
  switch (set) {
    case core::KernelSet::kMuller:
      return 1;
    case core::KernelSet::kCubicSpline:
      return 2;
    case core::KernelSet::kWendlandC2:
      break;
  }
  return 3;
}

}  // namespace

bool isPeriodicX(const core::WaveScene& wave) {
  return wave.boundary_minus_x == WaveBoundary::kPeriodic;
}
bool isPeriodicZ(const core::WaveScene& wave) {
  return wave.boundary_minus_z == WaveBoundary::kPeriodic;
}

bool isOpen(const core::Scene& scene) {
  const core::WaveScene& w = *scene.wave;
  for (const WaveBoundary side : {w.boundary_minus_x, w.boundary_plus_x, w.boundary_minus_z, w.boundary_plus_z}) {
    if (side == WaveBoundary::kAbsorb) return true;
  }
  return false;
}

bool isTwoWay(const core::Scene& scene) {
  return scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay;
}
bool hasSurfaceFoam(const core::Scene& scene) {
  return scene.wave && scene.foam && scene.foam->surface;
}
bool hasPressureHead(const core::Scene& scene) {
  return scene.wave && (scene.boats || isTwoWay(scene));
}
bool hasBreakers(const core::Scene& scene) {
  return scene.wave && (isTwoWay(scene) || hasSurfaceFoam(scene) || scene.wave->steepening_ratio > 0);
}
bool isSampled(const core::Scene& scene) {
  return scene.wave && (scene.coupling || scene.boats || hasBreakers(scene));
}

bool isVaried(const core::Scene& scene) {
  const core::WaveScene& w = *scene.wave;
  const bool has_walls = !isPeriodicX(w) || !isPeriodicZ(w);
  return isOpen(scene) || !scene.obstacles.empty() || !scene.beaches.empty() ||
         (has_walls && w.stencil == core::Stencil::kNinePoint);
}

bool countsNeighbours(const core::Scene& scene) {
  return scene.particles && scene.foam && scene.foam->neighbours_count > 0;
}

bool storesFoamSource(const core::Scene& scene) {
  return countsNeighbours(scene) && scene.particles->solver == core::PressureSolver::kWeaklyCompressible;
}

int followNumber(const core::Scene& scene) {
  if (!scene.coupling || isTwoWay(scene)) return 0;
  switch (scene.coupling->patch_follow) {
    case core::PatchFollow::kEvent:
      return 1;
    case core::PatchFollow::kBoat:
      return 2;
    case core::PatchFollow::kNothing:
      break;
  }
  return 0;
}

bool asksForOtherCount(const core::Scene& before, const core::Scene& after) {
  return before.particles && after.particles && before.particles->count != after.particles->count;
}

gpu::Defines shaderDefines(const core::Scene& scene) {
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool has_particles = scene.particles.has_value();
  // The particles of a two-way scene can be anywhere over the water and have the wave's sides.
  const bool periodic_x = isTwoWay(scene) ? isPeriodicX(*scene.wave)
                                          : has_particles && scene.particles->boundary_x == core::Boundary::kPeriodic;
  const bool periodic_z = isTwoWay(scene) ? isPeriodicZ(*scene.wave)
                                          : has_particles && scene.particles->boundary_z == core::Boundary::kPeriodic;
  return {{"PERIODIC_X", flag(periodic_x)},
          {"PERIODIC_Y", flag(has_particles && scene.particles->periodic_y)},
          {"PERIODIC_Z", flag(periodic_z)},
          {"COUPLED", flag(scene.coupling.has_value())},
          {"KERNEL_SET", std::to_string(has_particles ? kernelSetNumber(scene.particles->kernel_set) : 3)},
          {"FOAM", flag(scene.foam.has_value())},
          {"NEIGHBOUR_FOAM", flag(countsNeighbours(scene))},
          {"TAIT", flag(has_particles && scene.particles->equation_of_state == core::EquationOfState::kTait)},
          {"COHESION", flag(has_particles && scene.particles->cohesion)},
          {"MEAN_FORCE", flag(has_particles && scene.particles->pressure_force == core::PressureForce::kMean)},
          {"LATTICE", std::to_string(scene.coupling ? scene.coupling->lattice_count : 5)},
          {"STENCIL", scene.wave && scene.wave->stencil == core::Stencil::kNinePoint ? "9" : "5"},
          {"WAVE_PERIODIC_X", flag(scene.wave && isPeriodicX(*scene.wave))},
          {"WAVE_PERIODIC_Z", flag(scene.wave && isPeriodicZ(*scene.wave))},
          {"VARIED", flag(scene.wave && isVaried(scene))},
          {"OPEN", flag(scene.wave && isOpen(scene))},
          {"HEAD", flag(hasPressureHead(scene))},
          {"BREAKERS", flag(hasBreakers(scene))},
          {"WAVE", flag(scene.wave.has_value())},
          {"POOL_PARTICLES", flag(isTwoWay(scene))},
          {"FOLLOW", std::to_string(followNumber(scene))},
          {"HULLS", flag(scene.boats.has_value())},
          {"SURFACE_FOAM", flag(hasSurfaceFoam(scene))},
          {"LANDINGS", flag(hasSurfaceFoam(scene) && isTwoWay(scene))},
          {"STEEPEN", flag(scene.wave && scene.wave->steepening_ratio > 0)}};
}

}  // namespace spindrift::sim
