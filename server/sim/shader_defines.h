// The defines that specialise the shaders for a scene: only present parts are compiled.
#pragma once

#include <spindrift/core/scene.h>
#include <spindrift/gpu/program.h>

namespace spindrift::sim {

gpu::Defines shaderDefines(const core::Scene& scene);

}  // namespace spindrift::sim
