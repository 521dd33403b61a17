// Times of the simulation's passes on this machine.
#pragma once

#include <cstdio>

#include <boost/json/array.hpp>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>

namespace spindrift::bench {

/// Returns the scene with so many floaters of seven kinds in rows, that many sizes apart.
core::Scene withFloaters(core::Scene scene, std::uint32_t count, double sizes_apart);

/// Runs the scene, its parts alone and, if its number of particles is fixed, other numbers of particles, for `seconds`
/// of wall time each. Prints one row per case. Errors are those of the simulation, with the case's name.
core::Result<boost::json::array> measureSteps(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                              std::FILE* out);

}  // namespace spindrift::bench
