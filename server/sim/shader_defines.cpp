#include "shader_defines.h"

#include <string>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

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
          {"TENSION", flag(hasTension(scene))},
          {"MEAN_FORCE", flag(has_particles && scene.particles->pressure_force == core::PressureForce::kMean)},
          {"LATTICE", std::to_string(scene.coupling ? scene.coupling->lattice_count : 5)},
          {"STENCIL", scene.wave && scene.wave->stencil == core::Stencil::kNinePoint ? "9" : "5"},
          {"WAVE_PERIODIC_X", flag(scene.wave && isPeriodicX(*scene.wave))},
          {"WAVE_PERIODIC_Z", flag(scene.wave && isPeriodicZ(*scene.wave))},
          {"VARIED", flag(scene.wave && isVaried(scene))},
          {"OPEN", flag(scene.wave && isOpen(scene))},
          {"MAKERS", std::to_string(makerBits(scene))},
          {"EXCHANGE", flag(scene.wave && exchangesWater(scene))},
          {"MATCHED", flag(hasMatchedLayer(scene))},
          {"NONLINEAR", flag(isNonlinear(scene))},
          {"DISPERSE", flag(disperses(scene))},
          {"HEAD", flag(hasPressureHead(scene))},
          {"BREAKERS", flag(hasBreakers(scene))},
          {"WAVE", flag(scene.wave.has_value())},
          {"POOL_PARTICLES", flag(isTwoWay(scene))},
          {"FOLLOW", std::to_string(followNumber(scene))},
          {"FLOATING", flag(scene.floaters.has_value())},
          {"PUSHED", flag(scene.boats && scene.floaters)},
          {"HULLS", flag(scene.boats.has_value())},
          {"SURFACE_FOAM", flag(hasSurfaceFoam(scene))},
          {"LANDINGS", flag(hasSurfaceFoam(scene) && isTwoWay(scene))},
          {"STEEPEN", flag(scene.wave && scene.wave->steepening_ratio > 0)}};
}

}  // namespace spindrift::sim
