#include <charconv>
#include <optional>

#include <spindrift/gpu/device.h>

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
  std::vector<DeviceInfo> devices;
  std::optional<DeviceInfo> software;
  for (const egl::Candidate& candidate : egl::candidates()) {
    // There are several ways to the same software rasteriser; the first that works is the one to list.
    if (candidate.is_software && software && software->problem.empty()) continue;
    egl::Attempt attempt = egl::open(candidate);
    if (attempt.handles) egl::close(*attempt.handles);
    if (!candidate.is_software) {
      devices.push_back(std::move(attempt.info));
      continue;
    }
    if (attempt.handles && !attempt.info.is_software) {
      attempt.info.problem = "Mesa picks " + attempt.info.name + " here; LIBGL_ALWAYS_SOFTWARE=1 makes it use software";
      attempt.info.is_software = true;
    }
    software = std::move(attempt.info);
  }
  if (software) devices.push_back(std::move(*software));
  return devices;
}

}  // namespace spindrift::gpu
