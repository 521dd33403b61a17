// Sizes, times and errors of the layer codecs on real frames of a scene.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>

namespace spindrift::bench {

/// Runs the scene for a second and then for `seconds` (simulated), encodes and decodes every frame of the second part,
/// and prints one row per stream: bits per sample or particle beside the bound and beside deflate, times, largest
/// error.
core::Result<boost::json::object> measureCodecs(gpu::Context& ctx, const core::Scene& scene, double seconds,
                                                std::FILE* out);

}  // namespace spindrift::bench
