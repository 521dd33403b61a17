#include <EGL/egl.h>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/embedded_shader.h>
#include <spindrift/gpu/info.h>

#include "egl_display.h"

namespace spindrift::gpu {

GpuInfo collectInfo(const DeviceChoice& choice) {
  const egl::CurrentGuard guard;
  GpuInfo info;
  // Without a display EGL may refuse both queries; an old libEGL has no client version.
  if (const char* version = eglQueryString(EGL_NO_DISPLAY, EGL_VERSION)) info.egl_client_version = version;
  if (const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS)) info.egl_client_extensions = extensions;
  info.devices = listDevices();
  if (const auto context = Context::create(choice)) {
    info.chosen = (*context)->device();
    info.why = (*context)->why();
  } else {
    info.why = context.error().message;
  }
  info.shader_count = embeddedShaders().size();
  return info;
}

}  // namespace spindrift::gpu
