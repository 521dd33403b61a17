// What to do about devices that do not work. Plain logic: tests pass an imaginary machine. Private to this module.
#pragma once

#include <functional>
#include <string>

namespace spindrift::gpu {

/// Settings of a machine that decide which devices work, besides their drivers.
struct Machine {
  std::function<const char*(const char* name)> variable;      ///< std::getenv
  std::function<int(const std::string& file)> opening_error;  ///< errno of opening a file for reading and writing, or 0

  static Machine real();
};

/// Returns what keeps this process from a device's file, and what to do; empty if nothing does.
std::string fileAdvice(const std::string& file, const Machine& machine);

/// Returns which variables of the environment steer the drivers here, and that they should be unset; empty if none.
std::string variableAdvice(const Machine& machine);

/// Returns which hardware there is although EGL lists none, and what to do; empty without such hardware.
std::string unlistedAdvice(const Machine& machine);

}  // namespace spindrift::gpu
