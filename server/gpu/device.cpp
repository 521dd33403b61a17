#include <charconv>

#include <spindrift/gpu/device.h>

#include "device_probe.h"
#include "device_selection.h"
#include "egl_display.h"

namespace spindrift::gpu {

core::Result<DeviceChoice> parseDeviceChoice(std::string_view text) {
  constexpr int kMaxIndex = 1023;
  if (text == "auto") return DeviceChoice{DeviceChoice::Kind::kAuto, 0};
  if (text == "software") return DeviceChoice{DeviceChoice::Kind::kSoftware, 0};
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size() && index >= 0 && index <= kMaxIndex) {
    return DeviceChoice{DeviceChoice::Kind::kIndex, index};
  }
  return core::Error{core::ErrorCode::kInvalidInput, "device \"" + std::string(text) +
                                                         "\" is not auto, software or an index from 0 to " +
                                                         std::to_string(kMaxIndex) + "; see `spindrift info`"};
}

std::vector<DeviceInfo> listDevices() {
  const egl::CurrentGuard guard;
  return describeDevices(egl::candidates(), openUsable, egl::close);
}

}  // namespace spindrift::gpu
