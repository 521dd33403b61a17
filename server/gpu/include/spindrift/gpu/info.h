// What `spindrift info` prints about devices: plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu {

struct GpuInfo {
  std::string egl_client_version;  ///< what libEGL says without a display, empty when it says nothing
  std::string egl_client_extensions;
  std::vector<DeviceInfo> devices;   ///< listDevices()
  std::optional<DeviceInfo> chosen;  ///< the device that `choice` leads to; none when nothing works
  std::string why;                   ///< Context::why(), or the error when nothing works
  std::size_t shader_count = 0;      ///< entry points embedded in the program
};

/// Tries every device; takes some tenths of a second. Leaves the calling thread's current context as it was.
GpuInfo collectInfo(const DeviceChoice& choice);

}  // namespace spindrift::gpu
