// Which parts a scene has, and the defines that specialise its shaders: only what is present is compiled.
#pragma once

#include <spindrift/core/scene.h>
#include <spindrift/gpu/program.h>

namespace spindrift::sim {

/// Whether shaders need tables: the bed or the sides differ from a flat basin with periodic sides, or with walls under
/// the 5-point stencil.
bool isVaried(const core::Scene& scene);
/// Whether water can leave: a side absorbs.
bool isOpen(const core::Scene& scene);
/// Whether particles or boats look at the surface.
bool isSampled(const core::Scene& scene);
bool isTwoWay(const core::Scene& scene);
/// Returns whether the surface has external pressure: from hulls or falling particles.
bool hasPressureHead(const core::Scene& scene);
/// Returns whether any part needs the breaking map of the wave.
bool hasBreakers(const core::Scene& scene);
bool hasSurfaceFoam(const core::Scene& scene);
bool isPeriodicX(const core::WaveScene& wave);
bool isPeriodicZ(const core::WaveScene& wave);

/// Whether few neighbours make foam in this scene; the weakly compressible solver then keeps what its density pass
/// counted in one more buffer.
bool countsNeighbours(const core::Scene& scene);
bool storesFoamSource(const core::Scene& scene);

/// What the patch follows, as shaders/coupling/follow.comp numbers it; 0 = nothing.
int followNumber(const core::Scene& scene);

/// Whether a change of a scene with particles wants another number of them.
bool asksForOtherCount(const core::Scene& before, const core::Scene& after);

gpu::Defines shaderDefines(const core::Scene& scene);

}  // namespace spindrift::sim
