#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_state/relay_particles.h>

#include "shader_defines.h"

namespace spindrift::sim {
namespace {

/// Derives the values of the changed scene as for a fresh start; an error if the running room cannot take the change.
core::Result<Derived> checkChange(const core::Scene& scene, const SceneBasis& basis) {
  auto fresh = derive(scene);
  if (!fresh) return fresh;
  if (isNonlinear(scene) && scene.wave->depth_m != basis.scene.wave->depth_m) {
    return core::invalid(
        "wave.depth_m: cannot change while water with BULK_NONLINEAR runs, because its ground and its shore would "
        "move; start the room again with the changed scene");
  }
  const bool relays = asksForOtherCount(basis.scene, scene);
  if (relays && isTwoWay(basis.scene)) {
    // The device counts the slots of a pool, and their number is fixed.
    return core::invalid(
        "particles.count: cannot change while a two-way scene runs, where it is the size of the particle pool; start "
        "the room again with the changed scene");
  }
  // Compare with a fresh start of the scene before the change, except for the number of particles: no fresh start may
  // give the running layout.
  core::Scene comparable = basis.scene;
  if (relays) comparable.particles->count = scene.particles->count;
  const auto before = derive(comparable);
  if (!before || needsRestart(*before, *fresh) || shaderDefines(basis.scene) != shaderDefines(scene) ||
      (scene.particles && scene.particles->solver != basis.scene.particles->solver)) {
    return core::invalid("this change needs new buffers or shaders: start the room again with the changed scene");
  }
  return fresh;
}

}  // namespace

core::Result<PreparedScene> prepareScene(const core::Scene& scene, const SceneBasis& basis) {
  auto fresh = checkChange(scene, basis);
  if (!fresh) return fresh.error();
  PreparedScene out;
  out.scene = scene;
  out.revision = basis.revision;
  out.flow_ratio = keptFlowRatio(basis.scene, scene);
  if (!asksForOtherCount(basis.scene, scene)) {
    out.derived = *std::move(fresh);
    return out;
  }
  const auto layout = layOutAgain(scene, *basis.derived.particles);
  if (!layout) return layout.error();
  auto derived = derive(scene, &*layout);
  if (!derived) return derived.error();
  out.derived = *std::move(derived);
  out.particles = relayParticles(scene, basis.derived, basis.state, *layout);
  return out;
}

}  // namespace spindrift::sim
