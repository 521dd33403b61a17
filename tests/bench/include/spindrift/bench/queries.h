// What questions about the surface cost a room per tick.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::bench {

/// Runs a room of the scene, about `seconds` of wall time per case, in pairs of blocks: without questions, and with
/// streams of one answer per tick for so many points. What is timed is the room's whole round: it places the points,
/// samples them, and makes each answer and its bytes. Prints one row per case. Errors are those of the room.
core::Result<boost::json::object> measureQueries(const v1::Scene& scene, const gpu::DeviceChoice& device,
                                                 double seconds, std::FILE* out);

}  // namespace spindrift::bench
