// How many rooms a machine runs in real time.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>

namespace spindrift::bench {

/// Runs 1, 2, 3, … rooms of a scene in one process, each watched in full detail and encoded, for `seconds` each, until
/// one of them does not hold real time: a pool at draft fidelity, still water, and harbor. Then 64 small ones that
/// sleep because nobody watches. Prints, per number of rooms, the slowest and the mean real-time factor, and the
/// processor time per second, of all and per room. Call gpu::chooseRasterThreads() before. Errors: those of scenes
/// and rooms.
core::Result<boost::json::object> measureRooms(const gpu::DeviceChoice& device, double seconds, std::FILE* out);

}  // namespace spindrift::bench
