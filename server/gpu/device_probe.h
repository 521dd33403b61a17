// Whether a device really does what the program asks of it. Private to this module.
#pragma once

#include <string>

#include "egl_display.h"

namespace spindrift::gpu {

/// egl::open(), then the device's limits are compared with what the program needs and a small program is compiled and
/// run. On failure the context is closed and `info.problem` says why.
egl::Attempt openUsable(const egl::Candidate& candidate);

/// Runs shaders/device/probe.comp in the current context and looks at its result: storage and texel reads, a uniform
/// block, shared memory with a barrier, atomics and an indirect dispatch. Empty when it is right, else one line.
std::string runProbe();

}  // namespace spindrift::gpu
