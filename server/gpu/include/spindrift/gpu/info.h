// The device data that `spindrift info` prints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu {

struct GpuInfo {
  std::string egl_client_version;  ///< libEGL's client version without a display; empty when not available
  std::string egl_client_extensions;
  std::vector<DeviceInfo> devices;   ///< listDevices()
  std::optional<DeviceInfo> chosen;  ///< the device that `choice` selects; none when nothing works
  std::string why;                   ///< Context::why(), or the error when nothing works
  std::size_t shader_count = 0;      ///< entry points embedded in the program
};

/// Tries every device; takes some tenths of a second. Leaves the calling thread's current context unchanged.
GpuInfo collectInfo(const DeviceChoice& choice);

}  // namespace spindrift::gpu
