// Tests whether a device really does what the program needs. Private to this module.
#pragma once

#include <string>

#include "egl_display.h"

namespace spindrift::gpu {

/// Calls egl::open(), compares the device's limits with the program's needs, then compiles and runs a small program. On
/// failure the context is closed and `info.problem` holds the reason, and what to do where that can be told.
egl::Attempt openUsable(const egl::Candidate& candidate);

/// Runs shaders/device/probe.comp in the current context and checks its result: storage and texel reads, a uniform
/// block, shared memory with a barrier, atomics and an indirect dispatch. Returns an empty string on success, otherwise
/// one line.
std::string runProbe();

}  // namespace spindrift::gpu
