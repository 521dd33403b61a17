// The device of the tests: the software rasteriser, or the one in SPINDRIFT_TEST_DEVICE, which has the form of
// `--device`.
#pragma once

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

inline core::Result<DeviceChoice> testDevice() {
  const char* const wanted = std::getenv("SPINDRIFT_TEST_DEVICE");
  return parseDeviceChoice(wanted ? wanted : "software");
}

/// A context on that device; an error if the machine does not have it, for which tests are skipped. Throws, so that
/// tests fail, if the variable cannot be read.
inline core::Result<std::unique_ptr<Context>> testContext() {
  const auto choice = testDevice();
  if (!choice) throw std::invalid_argument("SPINDRIFT_TEST_DEVICE: " + choice.error().message);
  return Context::create(*choice);
}

}  // namespace spindrift::gpu
