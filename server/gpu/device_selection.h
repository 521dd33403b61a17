// Which of the ways to a device is taken. Plain logic without EGL, so that tests can try it with devices that are not
// there. Private to this module.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>

#include "egl_display.h"

namespace spindrift::gpu {

struct Selection {
  egl::Handles handles;
  DeviceInfo info;
  std::string why;  ///< one line
};

/// Opens a device and tries everything that the program needs of it.
using OpenDevice = std::function<egl::Attempt(const egl::Candidate&)>;
/// Undoes a successful OpenDevice.
using CloseDevice = std::function<void(const egl::Handles&)>;

/// Gives candidates that lead to one piece of hardware (the same DRM file or the same UUID, because two vendor
/// libraries list it) one index, that of the first of them, and numbers the others so that no index is left out. The
/// order stays.
void mergeDuplicates(std::vector<egl::Candidate>& candidates);

/// Tries what `choice` allows, in order, until one works. Error kNoDevice names all that were tried, with the reason
/// why each was not used.
core::Result<Selection> selectDevice(const std::vector<egl::Candidate>& candidates, const DeviceChoice& choice,
                                     const OpenDevice& open, const CloseDevice& close);

/// One entry per piece of hardware, in the order of their indices: the way that works, else the first one; then one for
/// software.
std::vector<DeviceInfo> describeDevices(const std::vector<egl::Candidate>& candidates, const OpenDevice& open,
                                        const CloseDevice& close);

}  // namespace spindrift::gpu
