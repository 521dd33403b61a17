// Selects a device, and says what to do about those that do not work. Plain logic without EGL, so that tests can use
// imaginary devices and machines. Private to this module.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>

#include "egl_display.h"

namespace spindrift::gpu {

/// Settings of a machine that decide which devices work, besides their drivers.
struct Machine {
  std::function<const char*(const char* name)> variable;      ///< std::getenv
  std::function<int(const std::string& file)> opening_error;  ///< errno of opening a file for reading and writing, or 0

  static Machine real();
};

/// Returns what keeps this process from a device's file, and what to do; empty if nothing does.
std::string fileAdvice(const std::string& file, const Machine& machine);

/// Opens a device and checks everything that the program needs of it.
using OpenDevice = std::function<egl::Attempt(const egl::Candidate&)>;
/// Reverses a successful OpenDevice.
using CloseDevice = std::function<void(const egl::Handles&)>;

/// Gives candidates that lead to the same hardware (same DRM file or same UUID, because two vendor libraries list it)
/// the index of the first of them, and renumbers the others without gaps. Keeps the order.
void mergeDuplicates(std::vector<egl::Candidate>& candidates);

/// Tries the candidates that `choice` allows, in order, until one works. Error kNoDevice lists all that were tried and
/// why each was not used.
core::Result<egl::Attempt> selectDevice(const std::vector<egl::Candidate>& candidates, const DeviceChoice& choice,
                                        const OpenDevice& open, const CloseDevice& close, const Machine& machine);

/// Returns one entry per piece of hardware, in the order of their indices: the candidate that works, otherwise the
/// first one; then one entry for software.
std::vector<DeviceInfo> describeDevices(const std::vector<egl::Candidate>& candidates, const OpenDevice& open,
                                        const CloseDevice& close);

}  // namespace spindrift::gpu
