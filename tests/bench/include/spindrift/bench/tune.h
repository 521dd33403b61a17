// Finds the fastest tuning profile of the device at hand.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>

namespace spindrift::bench {

/// Changes one field after the other of the profile of the device's class, on a pool of 8,192 and of 65,536 particles
/// and on a sea of 256 x 256 cells, and keeps what is faster by more than the spread. Takes at most three minutes; what
/// is not tried by then stays. Prints a row per value and scene and writes gpu::tuningFile(). Errors: no device; a
/// shipped scene is missing; kInternal, and no file, if a state depends on a field.
core::Result<boost::json::object> measureTuning(const gpu::DeviceChoice& device, std::FILE* out);

}  // namespace spindrift::bench
