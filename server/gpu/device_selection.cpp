#include "device_selection.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace spindrift::gpu {
namespace {

std::string label(const DeviceInfo& info) {
  return info.index >= 0 ? "device " + std::to_string(info.index) + " (" + info.name + ")" : info.name;
}

bool isSameHardware(const egl::Candidate& a, const egl::Candidate& b) {
  if (a.is_software || b.is_software) return false;
  return (!a.drm_file.empty() && a.drm_file == b.drm_file) || (!a.uuid.empty() && a.uuid == b.uuid);
}

std::string whyChosen(const DeviceInfo& info, DeviceChoice::Kind kind, int hardware_count) {
  switch (kind) {
    case DeviceChoice::Kind::kIndex:
      return "asked for by index";
    case DeviceChoice::Kind::kSoftware:
      return "software asked for";
    case DeviceChoice::Kind::kAuto:
      break;
  }
  if (!info.is_software) return "first hardware device with OpenGL 4.5 core that runs the program's shaders";
  return hardware_count == 0 ? "software, because EGL lists no hardware device"
                             : "software, because no hardware device works";
}

}  // namespace

void mergeDuplicates(std::vector<egl::Candidate>& candidates) {
  int next = 0;
  for (auto candidate = candidates.begin(); candidate != candidates.end(); ++candidate) {
    if (candidate->is_software) continue;
    const auto known = std::find_if(candidates.begin(), candidate,
                                    [&](const egl::Candidate& before) { return isSameHardware(before, *candidate); });
    candidate->index = known != candidate ? known->index : next++;
  }
}

core::Result<Selection> selectDevice(const std::vector<egl::Candidate>& candidates, const DeviceChoice& choice,
                                     const OpenDevice& open, const CloseDevice& close) {
  using Kind = DeviceChoice::Kind;
  int hardware_count = 0;
  for (const egl::Candidate& candidate : candidates) hardware_count = std::max(hardware_count, candidate.index + 1);
  if (choice.kind == Kind::kIndex && choice.index >= hardware_count) {
    return core::Error{core::ErrorCode::kNoDevice, "device " + std::to_string(choice.index) +
                                                       " does not exist: EGL lists " + std::to_string(hardware_count) +
                                                       " hardware devices; use auto or software, see `spindrift info`"};
  }
  std::string failures;
  for (const egl::Candidate& candidate : candidates) {
    if (choice.kind == Kind::kIndex && candidate.index != choice.index) continue;
    if (choice.kind == Kind::kSoftware && !candidate.is_software) continue;
    egl::Attempt attempt = open(candidate);
    DeviceInfo& info = attempt.info;
    if (attempt.handles && choice.kind == Kind::kSoftware && !info.is_software) {
      close(*attempt.handles);
      attempt.handles.reset();
      info.problem = "picks " + info.name + "; set LIBGL_ALWAYS_SOFTWARE=1";
    }
    if (attempt.handles) {
      std::string why = label(info) + ": " + whyChosen(info, choice.kind, hardware_count);
      if (!failures.empty()) why += "; not used: " + failures;
      return Selection{*attempt.handles, std::move(info), std::move(why)};
    }
    if (!failures.empty()) failures += ", ";
    failures += label(info) + ": " + info.problem;
  }
  return core::Error{core::ErrorCode::kNoDevice,
                     "no usable EGL device with OpenGL 4.5 (" + failures +
                         "); install your GPU's driver with EGL, or Mesa's software rasteriser: "
                         "apt install libegl1 libegl-mesa0 libgl1-mesa-dri"};
}

std::vector<DeviceInfo> describeDevices(const std::vector<egl::Candidate>& candidates, const OpenDevice& open,
                                        const CloseDevice& close) {
  std::vector<DeviceInfo> devices;
  std::optional<DeviceInfo> software;
  for (const egl::Candidate& candidate : candidates) {
    const auto known = std::ranges::find_if(
        devices, [&](const DeviceInfo& device) { return !candidate.is_software && device.index == candidate.index; });
    // Several candidates can lead to the same device; the first that works is listed.
    if (candidate.is_software && software && software->problem.empty()) continue;
    if (known != devices.end() && known->problem.empty()) continue;
    egl::Attempt attempt = open(candidate);
    if (attempt.handles) close(*attempt.handles);
    if (!candidate.is_software) {
      if (known == devices.end()) {
        devices.push_back(std::move(attempt.info));
      } else if (attempt.info.problem.empty()) {
        *known = std::move(attempt.info);
      }
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
