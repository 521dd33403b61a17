#include "device_selection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <utility>

#include <unistd.h>

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
    case DeviceChoice::Kind::kName:
      return "asked for by name";
    case DeviceChoice::Kind::kSoftware:
      return "software asked for";
    case DeviceChoice::Kind::kAuto:
      break;
  }
  if (!info.is_software) return "first hardware device with OpenGL 4.5 core that runs the program's shaders";
  return hardware_count == 0 ? "software, because EGL lists no hardware device"
                             : "software, because no hardware device works";
}

/// Returns the index of the hardware with this DRM file or UUID; -1 if no hardware has it.
int indexOf(const std::vector<egl::Candidate>& candidates, const std::string& name) {
  const auto found = std::ranges::find_if(candidates, [&](const egl::Candidate& candidate) {
    return !candidate.is_software &&
           (candidate.drm_file == name || candidate.render_file == name || candidate.uuid == name);
  });
  return found == candidates.end() ? -1 : found->index;
}

core::Error noSuchDevice(const std::string& asked, const std::vector<egl::Candidate>& candidates) {
  std::string listed;
  for (const egl::Candidate& candidate : candidates) {
    if (candidate.is_software) continue;
    listed += (listed.empty() ? "" : ", ") + std::to_string(candidate.index);
    for (const std::string& name : {candidate.drm_file, candidate.render_file, candidate.uuid}) {
      if (!name.empty()) listed += " " + name;
    }
  }
  return {core::ErrorCode::kNoDevice, "device " + asked + " does not exist: EGL lists " +
                                          (listed.empty() ? "no hardware devices" : "the hardware devices " + listed) +
                                          "; use auto or software, see `spindrift info`"};
}

/// Returns which variables of the environment steer the drivers here, and that they should be unset; empty if none.
std::string variableAdvice(const Machine& machine) {
  // Of Mesa, its loader and libglvnd.
  constexpr std::array kNames = {"GALLIUM_DRIVER",
                                 "LIBGL_ALWAYS_SOFTWARE",
                                 "LIBGL_DRIVERS_PATH",
                                 "MESA_EXTENSION_OVERRIDE",
                                 "MESA_GL_VERSION_OVERRIDE",
                                 "MESA_GLSL_VERSION_OVERRIDE",
                                 "MESA_LOADER_DRIVER_OVERRIDE",
                                 "__EGL_VENDOR_LIBRARY_DIRS",
                                 "__EGL_VENDOR_LIBRARY_FILENAMES"};
  std::string set;
  for (const char* const name : kNames) {
    if (const char* const value = machine.variable(name))
      set += (set.empty() ? "" : ", ") + std::string(name) + "=" + value;
  }
  return set.empty() ? "" : "the environment chooses drivers or versions (" + set + "): unset that and try again";
}

/// Returns which hardware there is although EGL lists none, and what to do; empty without such hardware.
std::string unlistedAdvice(const Machine& machine) {
  if (machine.opening_error("/dev/nvidiactl") != ENOENT) {
    return "there is an NVIDIA driver (/dev/nvidiactl): install its library for EGL (libnvidia-gl), or give a "
           "container "
           "NVIDIA_DRIVER_CAPABILITIES=graphics,compute,utility";
  }
  constexpr const char* kRenderNode = "/dev/dri/renderD128";
  if (machine.opening_error(kRenderNode) == ENOENT) return "";
  const std::string why = fileAdvice(kRenderNode, machine);
  return why.empty() ? std::string("there is a GPU (") + kRenderNode +
                           "): install its driver for EGL, for Mesa: apt install libegl-mesa0 libgl1-mesa-dri"
                     : why;
}

/// What to do where `auto` ended in software although there is, or may be, hardware; empty without such hardware.
std::string adviceAfter(const DeviceInfo& info, DeviceChoice::Kind kind, int hardware_count, const Machine& machine) {
  if (kind != DeviceChoice::Kind::kAuto || !info.is_software) return "";
  const std::string ending = "; --device software asks for software without this warning";
  if (hardware_count == 0) {
    const std::string unlisted = unlistedAdvice(machine);
    return unlisted.empty() ? "" : unlisted + ending;
  }
  const std::string variables = variableAdvice(machine);
  return (variables.empty() ? "make the hardware usable, or update its driver with EGL" : variables) + ending;
}

}  // namespace

Machine Machine::real() {
  return {
      .variable = [](const char* name) -> const char* { return std::getenv(name); },
      .opening_error = [](const std::string& file) { return ::access(file.c_str(), R_OK | W_OK) == 0 ? 0 : errno; }};
}

std::string fileAdvice(const std::string& file, const Machine& machine) {
  const int error = file.empty() ? 0 : machine.opening_error(file);
  if (error == EACCES || error == EPERM) {
    return "this user may not open " + file +
           ": add it to the group of that file (usermod -aG render USER), or give a container this group (--group-add)";
  }
  if (error == ENOENT) return file + " does not exist here: pass it to the container (--device " + file + ")";
  return "";
}

void mergeDuplicates(std::vector<egl::Candidate>& candidates) {
  int next = 0;
  for (auto candidate = candidates.begin(); candidate != candidates.end(); ++candidate) {
    if (candidate->is_software) continue;
    const auto known = std::find_if(candidates.begin(), candidate,
                                    [&](const egl::Candidate& before) { return isSameHardware(before, *candidate); });
    candidate->index = known != candidate ? known->index : next++;
  }
}

core::Result<egl::Attempt> selectDevice(const std::vector<egl::Candidate>& candidates, const DeviceChoice& choice,
                                        const OpenDevice& open, const CloseDevice& close, const Machine& machine) {
  using Kind = DeviceChoice::Kind;
  int hardware_count = 0;
  for (const egl::Candidate& candidate : candidates) hardware_count = std::max(hardware_count, candidate.index + 1);
  const bool is_one = choice.kind == Kind::kIndex || choice.kind == Kind::kName;
  const int index = choice.kind == Kind::kName ? indexOf(candidates, choice.name) : choice.index;
  if (is_one && (index < 0 || index >= hardware_count)) {
    return noSuchDevice(choice.kind == Kind::kName ? choice.name : std::to_string(choice.index), candidates);
  }
  std::string failures;
  for (const egl::Candidate& candidate : candidates) {
    if (is_one && candidate.index != index) continue;
    if (choice.kind == Kind::kSoftware && !candidate.is_software) continue;
    egl::Attempt attempt = open(candidate);
    DeviceInfo& info = attempt.info;
    if (attempt.handles && choice.kind == Kind::kSoftware && !info.is_software) {
      close(*attempt.handles);
      attempt.handles.reset();
      info.problem = "picks " + info.name + "; set LIBGL_ALWAYS_SOFTWARE=1";
    }
    if (attempt.handles) {
      info.why = label(info) + ": " + whyChosen(info, choice.kind, hardware_count);
      if (!failures.empty()) info.why += "; not used: " + failures;
      info.advice = adviceAfter(info, choice.kind, hardware_count, machine);
      return attempt;
    }
    const std::string failure = label(info) + ": " + info.problem;
    if (failures.find(failure) != std::string::npos) continue;  // another display of the same rasteriser
    failures += (failures.empty() ? "" : ", ") + failure;
  }
  const std::string variables = variableAdvice(machine);
  return core::Error{core::ErrorCode::kNoDevice,
                     "no usable EGL device with OpenGL 4.5 (" + failures + "); " +
                         (variables.empty() ? "install your GPU's driver with EGL, or Mesa's software rasteriser: "
                                              "apt install libegl1 libegl-mesa0 libgl1-mesa-dri"
                                            : variables)};
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
      attempt.info.problem = "EGL gives " + attempt.info.name + " in its place: Mesa is not installed, or prefers it" +
                             " (LIBGL_ALWAYS_SOFTWARE=1 makes Mesa use software)";
      attempt.info.is_software = true;
    }
    software = std::move(attempt.info);
  }
  if (software) devices.push_back(std::move(*software));
  return devices;
}

}  // namespace spindrift::gpu
