// One server with many clients: cost of a frame per client, delays, and the effect of clients that do not read.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::bench {

/// Measures the network module alone with synthetic frames (100 readers; the same with ten that never read; 200 small
/// ones with visitors and commands), then the whole server with the scene and 200 clients. Measures `seconds` per case,
/// with clients and server in this process. Prints one row per case.
core::Result<boost::json::object> measureFanout(const v1::Scene& scene, const std::string& device, double seconds,
                                                std::FILE* out);

}  // namespace spindrift::bench
