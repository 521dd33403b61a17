// The side that waves come from where none is named. Pure function of the scene.
#pragma once

#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// Returns the side with the deepest water, land and obstacles counted as no depth; of sides that are about as deep,
/// the first one that is open to the sea, otherwise the first one: +x, -x, +z, -z. kPlusX in scenes without a wave.
core::Side openSide(const core::Scene& scene);

}  // namespace spindrift::sim
