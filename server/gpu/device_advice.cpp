#include "device_advice.h"

#include <array>
#include <cerrno>
#include <cstdlib>

#include <unistd.h>

namespace spindrift::gpu {

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

}  // namespace spindrift::gpu
