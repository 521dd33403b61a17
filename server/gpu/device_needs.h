// Minimum limits of a device for the program to run at all. Further needs of a scene are checked when its buffers are
// made. Private to this module.
#pragma once

#include <string>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu {

/// The only place with these limits: devices below them are refused, and tests fail for a shader that uses more.
inline constexpr DeviceLimits kNeededLimits = {
    .max_ssbo_bytes = 1 << 24,             // OpenGL 4.5 promises as much
    .max_texel_buffer_elements = 1 << 16,  // likewise
    .max_uniform_block_bytes = 1 << 14,    // likewise
    .max_work_group_invocations = 256,     // SCAN_GROUP
    .max_work_group_count_x = 65535,
    .max_work_group_count_y = 65535,
    .max_work_group_count_z = 64,
    .max_shared_memory_bytes = 1 << 10,  // SCAN_GROUP words
    .max_ssbo_bindings = 40,  // the numbers in shaders/shared/bindings.h; OpenGL promises 8, drivers have 72 and more
    .max_compute_ssbo_blocks = 8,
    .max_compute_texture_units = 16,
    .max_combined_texture_units = 40,  // the same numbers; OpenGL promises 96
};

/// Reads the limits of the current context.
DeviceLimits currentLimits();

/// Returns an empty string when `limits` meet all of `needs`, otherwise one line with each limit that is too low, its
/// value and the needed value.
std::string missingLimits(const DeviceLimits& limits, const DeviceLimits& needs = kNeededLimits);

}  // namespace spindrift::gpu
