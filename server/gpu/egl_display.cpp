#include "egl_display.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <EGL/eglext.h>
#include <fmt/format.h>
#include <glad/gl.h>

#include "device_needs.h"
#include "device_selection.h"

namespace spindrift::gpu::egl {
namespace {

std::string text(const char* value) {
  return value ? value : "";
}
std::string text(const GLubyte* value) {
  return value ? reinterpret_cast<const char*>(value) : "";
}

/// `words`: separated by blanks.
bool hasWord(const std::string& words, const std::string& word) {
  return (" " + words + " ").find(" " + word + " ") != std::string::npos;
}

std::string eglErrorText() {
  constexpr std::pair<EGLint, const char*> kErrors[] = {{EGL_SUCCESS, "no EGL error"},
                                                        {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
                                                        {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
                                                        {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
                                                        {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
                                                        {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
                                                        {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
                                                        {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
                                                        {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"}};
  const EGLint code = eglGetError();
  for (const auto& [known, name] : kErrors) {
    if (code == known) return name;
  }
  return "EGL error " + std::to_string(code);
}

/// Of Mesa: threads of its software rasteriser. 0: it computes on the calling thread.
constexpr const char* kRasterThreads = "LP_NUM_THREADS";

/// Displays of the software rasteriser: the device's and the surfaceless platform's, twice each. Where it computes on
/// the calling thread, Mesa carries out one dispatch at a time per display.
constexpr int kLaneCount = 4;
/// Contexts that exist in each.
std::array<std::atomic<int>, kLaneCount> lane_context_counts{};

/// The displays of the lanes from here on are asked for with an empty list of attributes instead of none: other
/// displays for Mesa, and for another EGL perhaps the same.
constexpr int kEmptyListLane = 2;

/// Uses the core entry point of EGL 1.5, otherwise the extension's. Both must be queried before any display exists.
EGLDisplay platformDisplay(EGLenum platform, void* native, int lane) {
  static constexpr EGLAttrib kEmptyList[] = {EGL_NONE};
  const EGLAttrib* attributes = lane >= kEmptyListLane ? kEmptyList : nullptr;
  if (const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYPROC>(eglGetProcAddress("eglGetPlatformDisplay"))) {
    if (EGLDisplay display = get(platform, native, attributes); display != EGL_NO_DISPLAY) return display;
  }
  if (const auto get =
          reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"))) {
    if (EGLDisplay display = get(platform, native, nullptr); display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

EGLDisplay displayOf(const Candidate& candidate) {
  return candidate.device ? platformDisplay(EGL_PLATFORM_DEVICE_EXT, candidate.device, candidate.lane)
                          : platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, candidate.lane);
}

/// Loads the OpenGL functions once, since they are the same for every context of the process. A context must be
/// current.
bool loadOpenGl() {
  static std::mutex mutex;
  static bool is_loaded = false;
  const std::lock_guard lock(mutex);
  if (!is_loaded) is_loaded = gladLoadGL(eglGetProcAddress) != 0;
  return is_loaded;
}

bool isSoftwareRenderer(std::string_view renderer) {
  constexpr std::array<std::string_view, 4> kSoftware = {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"};
  return std::any_of(kSoftware.begin(), kSoftware.end(),
                     [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

void describeCurrent(DeviceInfo& info) {
  info.name = text(glGetString(GL_RENDERER));
  info.vendor = text(glGetString(GL_VENDOR));
  info.gl_version = text(glGetString(GL_VERSION));
  info.glsl_version = text(glGetString(GL_SHADING_LANGUAGE_VERSION));
  info.limits = currentLimits();
}

/// Returns the UUID of EGL_EXT_device_persistent_id as DeviceInfo has it, or an empty string.
std::string deviceUuid(EGLDeviceEXT device, const std::string& extensions) {
  // Values from the extension's specification; older headers do not have them.
  constexpr EGLint kDeviceUuid = 0x335C;  // EGL_DEVICE_UUID_EXT
  using QueryBinary = EGLBoolean (*)(EGLDeviceEXT, EGLint, EGLint, void*, EGLint*);
  if (!hasWord(extensions, "EGL_EXT_device_persistent_id")) return {};
  const auto query = reinterpret_cast<QueryBinary>(eglGetProcAddress("eglQueryDeviceBinaryEXT"));
  std::array<unsigned char, 16> uuid{};
  EGLint size_bytes = 0;
  if (!query || !query(device, kDeviceUuid, uuid.size(), uuid.data(), &size_bytes)) return {};
  if (size_bytes != static_cast<EGLint>(uuid.size())) return {};
  std::string out = fmt::format("{:02x}", fmt::join(uuid, ""));
  for (const std::size_t at : {8, 13, 18, 23}) out.insert(at, 1, '-');
  return out;
}

/// Creates an OpenGL 4.5 core context that reports resets, or one that does not if the driver has no such feature.
EGLContext createContext(EGLDisplay display, bool& tells_of_resets) {
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                    EGL_CONTEXT_MINOR_VERSION,       5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
#ifndef NDEBUG
  // Without it drivers may report nothing; release builds avoid its cost.
  attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
#endif
  // The attribute of EGL 1.5 and that of the extension have the same meaning, but different numbers.
  for (const EGLint strategy :
       {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT, EGL_NONE}) {
    std::vector<EGLint> asked = attributes;
    if (strategy != EGL_NONE) asked.insert(asked.end(), {strategy, EGL_LOSE_CONTEXT_ON_RESET});
    asked.push_back(EGL_NONE);
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, asked.data());
    tells_of_resets = context != EGL_NO_CONTEXT && strategy != EGL_NONE;
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

/// Returns what the driver offers in place of OpenGL 4.5, or an empty string. Leaves no context current.
std::string olderVersion(EGLDisplay display) {
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
  if (context == EGL_NO_CONTEXT) return {};
  std::string out;
  // Not from the loader: it would keep the functions of this version for the whole process.
  const auto get = reinterpret_cast<const GLubyte* (*)(GLenum)>(eglGetProcAddress("glGetString"));
  if (get && makeCurrent({display, context})) out = text(get(GL_VERSION)) + " of " + text(get(GL_RENDERER));
  close({display, context});
  return out;
}

/// Returns whether contexts on several threads compute at the same time only if they have displays of their own.
bool computesOnCaller() {
  const char* const count = std::getenv(kRasterThreads);
  return count && std::string_view(count) == "0";
}

/// Returns the software candidates once per display that they lead to, those with the fewest contexts first. Where the
/// rasteriser has threads, all contexts share the first display and its threads.
std::vector<Candidate> lanesOf(const std::vector<Candidate>& software) {
  std::vector<std::pair<int, Candidate>> lanes;
  for (const int first_lane : {0, kEmptyListLane}) {
    if (first_lane > 0 && !computesOnCaller()) break;
    for (int k = 0; k < std::min<int>(kEmptyListLane, static_cast<int>(software.size())); ++k) {
      Candidate candidate = software[static_cast<std::size_t>(k)];
      candidate.lane = first_lane + k;
      lanes.emplace_back(lane_context_counts[static_cast<std::size_t>(candidate.lane)], candidate);
    }
  }
  if (computesOnCaller()) std::ranges::stable_sort(lanes, {}, &std::pair<int, Candidate>::first);
  std::vector<Candidate> out;
  for (auto& [count, candidate] : lanes) out.push_back(std::move(candidate));
  return out;
}

}  // namespace

std::vector<Candidate> candidates() {
  std::vector<Candidate> hardware;
  std::vector<Candidate> software;
  const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto query_string =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
  EGLint count = 0;
  if (query_devices && query_string && query_devices(0, nullptr, &count) && count > 0) {
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!query_devices(count, devices.data(), &count)) count = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const std::string extensions = text(query_string(devices[i], EGL_EXTENSIONS));
      Candidate candidate;
      candidate.device = devices[i];
      candidate.is_software = hasWord(extensions, "EGL_MESA_device_software");
      if (hasWord(extensions, "EGL_EXT_device_drm")) {
        candidate.drm_file = text(query_string(devices[i], EGL_DRM_DEVICE_FILE_EXT));
      }
      if (hasWord(extensions, "EGL_EXT_device_drm_render_node")) {
        candidate.render_file = text(query_string(devices[i], EGL_DRM_RENDER_NODE_FILE_EXT));
      }
      candidate.uuid = deviceUuid(devices[i], extensions);
      (candidate.is_software ? software : hardware).push_back(candidate);
    }
  }
  Candidate surfaceless;
  surfaceless.is_software = true;
  software.push_back(surfaceless);
  software = lanesOf(software);
  hardware.insert(hardware.end(), software.begin(), software.end());
  mergeDuplicates(hardware);
  return hardware;
}

Attempt open(const Candidate& candidate) {
  Attempt attempt;
  DeviceInfo& info = attempt.info;
  info.index = candidate.index;
  info.is_software = candidate.is_software;
  info.drm_file = candidate.drm_file;
  info.render_file = candidate.render_file;
  info.uuid = candidate.uuid;
  info.name = candidate.device ? "EGL device " + candidate.drm_file : "Mesa surfaceless platform";
  const auto fail = [&](const std::string& what) {
    info.problem = what;
    return attempt;
  };

  Handles handles;
  handles.display = displayOf(candidate);
  if (handles.display == EGL_NO_DISPLAY) return fail("EGL has no display for it");
  if (!eglInitialize(handles.display, nullptr, nullptr)) {
    return fail("its EGL display does not initialise (" + eglErrorText() + ")");
  }
  info.egl_driver =
      text(eglQueryString(handles.display, EGL_VENDOR)) + " " + text(eglQueryString(handles.display, EGL_VERSION));
  if (!eglBindAPI(EGL_OPENGL_API)) return fail("its EGL driver knows no desktop OpenGL");

  handles.context = createContext(handles.display, info.tells_of_resets);
  handles.lane = candidate.lane;
  if (handles.context == EGL_NO_CONTEXT) {
    const std::string error = eglErrorText();
    const std::string older = olderVersion(handles.display);
    return fail("no OpenGL 4.5 core context (" + error + (older.empty() ? ")" : "; it has " + older + ")"));
  }
  if (handles.lane >= 0) ++lane_context_counts[static_cast<std::size_t>(handles.lane)];
  if (!makeCurrent(handles)) {
    const std::string error = eglErrorText();
    close(handles);
    return fail("its context cannot be used without a window (" + error + ")");
  }
  if (!loadOpenGl()) {
    close(handles);
    return fail("its OpenGL functions cannot be loaded");
  }
  describeCurrent(info);
  const bool renders_in_software = isSoftwareRenderer(info.name);
  if (renders_in_software && !candidate.is_software) {
    close(handles);
    return fail("it has no driver of its own and would fall back to software");
  }
  // The surfaceless platform chooses hardware if it can.
  info.is_software = renders_in_software;
  attempt.handles = handles;
  return attempt;
}

void close(const Handles& handles) {
  if (eglGetCurrentContext() == handles.context) makeCurrent({handles.display, EGL_NO_CONTEXT});
  eglDestroyContext(handles.display, handles.context);
  if (handles.lane >= 0) --lane_context_counts[static_cast<std::size_t>(handles.lane)];
}

bool makeCurrent(const Handles& handles) {
  // The bound API is a property of the thread.
  return eglBindAPI(EGL_OPENGL_API) &&
         eglMakeCurrent(handles.display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles.context) == EGL_TRUE;
}

CurrentGuard::CurrentGuard()
    : display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)) {}

CurrentGuard::~CurrentGuard() {
  if (context_ != EGL_NO_CONTEXT) eglMakeCurrent(display_, draw_, read_, context_);
}

}  // namespace spindrift::gpu::egl

namespace spindrift::gpu {

void chooseRasterThreads(unsigned processor_count) {
  if (processor_count <= 2) ::setenv(egl::kRasterThreads, "0", 0);
}

}  // namespace spindrift::gpu
