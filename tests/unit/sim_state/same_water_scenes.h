// Scenes whose water continues at another resolution.
#pragma once

#include <cstdint>

#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// A harbor without particles: an absorbing side, a rock, a thin breakwater, a beach that runs dry, a boat.
inline core::Scene harbor(std::uint32_t resolution_count) {
  core::Scene scene;
  scene.name = "harbor";
  scene.wave.emplace();
  scene.wave->resolution_count = resolution_count;
  scene.wave->side_m = 16.0;
  scene.wave->depth_m = 1.5;
  scene.wave->boundary_minus_x = core::WaveBoundary::kAbsorb;
  scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
  scene.wave->boundary_minus_z = core::WaveBoundary::kReflect;
  scene.wave->boundary_plus_z = core::WaveBoundary::kReflect;
  scene.wave->sponge_width_m = 2.0;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.wave->damping_per_s = 0.0;
  scene.obstacles = {core::Rock{3.0, 1.0, 1.1, 0.5}, core::Breakwater{-1.0, -3.0, 6.0, 0.4, 30.0, 0.5}};
  scene.beaches = {core::Beach{core::Side::kPlusX, 3.0, 0.0}};
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{.x_m = -4.0, .z_m = 3.0}};
  return scene;
}

inline core::Scene basin(std::uint32_t resolution_count) {
  core::Scene scene = harbor(resolution_count);
  scene.obstacles.clear();
  scene.beaches.clear();
  scene.boats.reset();
  scene.wave->boundary_minus_x = core::WaveBoundary::kReflect;
  return scene;
}

inline core::Scene twoWay(std::uint32_t resolution_count, double droplet_spacing_m) {
  core::Scene scene = basin(resolution_count);
  scene.particles.emplace();
  scene.particles->count = 4000;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.coupling->droplet_spacing_m = droplet_spacing_m;
  return scene;
}

}  // namespace spindrift::sim
