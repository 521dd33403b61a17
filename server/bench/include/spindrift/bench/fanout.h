// One server, many clients: what a frame costs per client, how late it comes, and what clients that do not read change.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::bench {

/// The network module alone with made-up frames (100 readers; the same with ten that never read; 200 small ones with
/// visitors and commands), then the whole server with the scene and 200 clients. `seconds` measured per case, clients
/// and server in this process. Prints a row a case.
core::Result<boost::json::object> measureFanout(const v1::Scene& scene, const std::string& device, double seconds,
                                                std::FILE* out);

}  // namespace spindrift::bench
