// EGL without a window system: the list of devices, and a context on one of them. Private to this module.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <EGL/egl.h>

#include <spindrift/gpu/device.h>

namespace spindrift::gpu::egl {

/// A device or platform through which a display can be opened.
struct Candidate {
  void* device = nullptr;  ///< EGLDeviceEXT; null: Mesa's surfaceless platform, which picks a driver by itself
  bool is_software = false;
  int lane = -1;            ///< of software: which of its displays, 0 and up
  int index = -1;           ///< position among the hardware devices, -1 for software
  std::string drm_file;     ///< empty when EGL does not report it
  std::string render_file;  ///< the same
  std::string uuid;         ///< of the hardware, with any driver, as in DeviceInfo; empty when not reported
};

/// A context on an initialised display.
struct Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  int lane = -1;  ///< as Candidate::lane
};

/// Result of trying a candidate. Without handles, `info.problem` holds the reason.
struct Attempt {
  DeviceInfo info;
  std::optional<Handles> handles;
};

/// Returns hardware devices in EGL's order, then the candidates for software rendering: its displays, those with the
/// fewest contexts first. Candidates for the same hardware have the same index.
std::vector<Candidate> candidates();

/// Opens the display, makes an OpenGL 4.5 core context, makes it current on this thread, loads the OpenGL functions and
/// describes the device. After a failure no context is current.
Attempt open(const Candidate& candidate);

/// Calls open(), compares the device's limits with the program's needs, then compiles and runs a small program. On
/// failure the context is closed and `info.problem` holds the reason, and what to do where that can be told.
Attempt openUsable(const Candidate& candidate);

/// Destroys the context; unbinds it first when it is current here. The display stays initialised: EGL gives the same
/// display to every caller that asks for the device, and eglTerminate would end it for all of them.
void close(const Handles& handles);

/// Makes the context current on this thread, or nothing when `handles.context` is EGL_NO_CONTEXT.
bool makeCurrent(const Handles& handles);

/// Restores the previously current context of this thread.
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
