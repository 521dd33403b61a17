// One server with many clients: cost of a frame per client, delays, and the effect of clients that do not read.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::bench {

/// Compares broadcasts of 200 kB and 4 kB to 100 readers with a thread that only sends, in turn, without TLS. Then
/// measures the network module alone with synthetic frames (100 readers; the same with ten that never read; 200 small
/// ones with visitors and commands), then the whole server with the scene and 200 clients. Measures `seconds` per case,
/// with clients and server in this process. Prints one row per case. With `tls` all connections are TLS; the clients
/// trust its certificate, which is for 127.0.0.1.
core::Result<boost::json::object> measureFanout(const v1::Scene& scene, const std::string& device, double seconds,
                                                const std::optional<net::TlsFiles>& tls, std::FILE* out);

}  // namespace spindrift::bench
