// A starting scene for tests of the simulation and of its set-up.
#pragma once

#include <cstdint>

#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// A small scene with every part: 32^2 wave of 8 m, about `count` particles in 3 layers.
inline core::Scene smallScene(std::uint32_t count = 600) {
  core::Scene scene;
  scene.name = "test";
  scene.wave.emplace();
  scene.wave->resolution_count = 32;
  scene.wave->side_m = 8.0;
  scene.particles.emplace();
  scene.particles->count = count;
  scene.particles->viscosity_pas = 100.0;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.foam.emplace();
  return scene;
}

}  // namespace spindrift::sim
