// EGL without a window system: which devices there are, and a context on one of them. Private to this module.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <EGL/egl.h>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu::egl {

/// A way to a display that has not been opened yet.
struct Candidate {
  void* device = nullptr;  ///< EGLDeviceEXT; null: Mesa's surfaceless platform, which picks a driver by itself
  bool is_software = false;
  int index = -1;        ///< position among the hardware devices, -1 for software
  std::string drm_file;  ///< empty when EGL does not tell
  std::string uuid;      ///< 16 bytes that name the hardware whichever driver drives it; empty when EGL does not tell
};

/// A context on an initialised display.
struct Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

/// A candidate that was tried. Without handles `info.problem` says why.
struct Attempt {
  DeviceInfo info;
  std::optional<Handles> handles;
};

/// Hardware devices in EGL's order, then the ways to software rendering, best first. Ways to one piece of hardware have
/// one index.
std::vector<Candidate> candidates();

/// Opens the display, makes an OpenGL 4.5 core context, makes it current on this thread, loads the OpenGL functions and
/// describes the device. After a failure nothing is current.
Attempt open(const Candidate& candidate);

/// Destroys the context; unbinds it first when it is current here. The display stays initialised: EGL hands the same
/// display to everyone who asks for the device, and eglTerminate would end it for all of them.
void close(const Handles& handles);

/// Makes the context current on this thread, or nothing when `handles.context` is EGL_NO_CONTEXT.
bool makeCurrent(const Handles& handles);

/// Puts back what was current on this thread.
class CurrentGuard {
 public:
  CurrentGuard();
  ~CurrentGuard();
  CurrentGuard(const CurrentGuard&) = delete;
  CurrentGuard& operator=(const CurrentGuard&) = delete;

 private:
  EGLDisplay display_;
  EGLContext context_;
  EGLSurface draw_;
  EGLSurface read_;
};

}  // namespace spindrift::gpu::egl
