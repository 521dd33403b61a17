// Clients of a real room: each says hello, subscribes to every layer packed at 20 Hz, and sends a splash from time to
// time.
#pragma once

#include <cstddef>

#include <spindrift/bench/crowd.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::bench {

CrowdOptions sceneCrowd(const v1::Scene& scene, std::size_t client_count, double seconds);

}  // namespace spindrift::bench
