// Device selection: EGL devices that can make an OpenGL 4.5 core context, hardware first, software last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/tuning_profile.h>

namespace spindrift::gpu {

/// The user's choice with `--device auto|software|N|FILE|UUID`.
struct DeviceChoice {
  enum class Kind {
    kAuto,      ///< the first hardware device that meets the program's needs and passes a probe, otherwise software
    kSoftware,  ///< Mesa's software rasteriser
    kIndex,     ///< the hardware device with this index in GpuInfo::devices
    kName,      ///< the hardware device with this DRM file or UUID
  };
  Kind kind = Kind::kAuto;
  int index = 0;       ///< for kIndex only
  std::string name{};  ///< for kName only: a path with links resolved, or a UUID as in DeviceInfo
  /// For shader development: the folder from which shaders are read; empty: the embedded shaders. See
  /// Context::reloadChangedShaders().
  std::string shader_folder{};
  /// For tests and measurements: the tuning profile; nothing: chosenTuning().
  std::optional<TuningProfile> tuning{};
};

/// Reads "auto", "software", a device index (0…1023), a DRM file (/dev/dri/renderD128, or a link to it), or a UUID with
/// or without "GPU-". Error kInvalidInput otherwise.
core::Result<DeviceChoice> parseDeviceChoice(std::string_view text);

/// For a program whose contexts work side by side on threads of their own; call it before the first thread starts. On
/// up to two processors the software rasteriser then computes on the thread of each context; on more it keeps its
/// threads for all processors. LP_NUM_THREADS in the environment overrides it; hardware is not affected.
void chooseRasterThreads(unsigned processor_count);

/// Limits of a device's context; all zero for a device that does not work.
struct DeviceLimits {
  std::int64_t max_ssbo_bytes = 0;             ///< one shader storage block
  std::int64_t max_texel_buffer_elements = 0;  ///< texels of one buffer texture
  std::int64_t max_uniform_block_bytes = 0;
  std::int64_t max_work_group_invocations = 0;  ///< x * y * z of a local size
  std::int64_t max_work_group_count_x = 0;      ///< groups of one dispatch along x; y and z follow
  std::int64_t max_work_group_count_y = 0;
  std::int64_t max_work_group_count_z = 0;
  std::int64_t max_shared_memory_bytes = 0;
  std::int64_t max_ssbo_bindings = 0;           ///< binding points in all
  std::int64_t max_compute_ssbo_blocks = 0;     ///< storage blocks that one compute shader may use
  std::int64_t max_compute_texture_units = 0;   ///< samplers that one compute shader may use
  std::int64_t max_combined_texture_units = 0;  ///< texture units in all
};

struct DeviceInfo {
  int index = -1;            ///< what `--device` takes; -1 for the software rasteriser
  std::string name;          ///< GL_RENDERER, or EGL's name of a device that does not work
  std::string vendor;        ///< GL_VENDOR
  std::string gl_version;    ///< GL_VERSION
  std::string glsl_version;  ///< GL_SHADING_LANGUAGE_VERSION
  std::string egl_driver;    ///< EGL_VENDOR and EGL_VERSION of the display, e.g. "Mesa Project 1.5"
  std::string drm_file;      ///< device file, empty when the device has none
  std::string render_file;   ///< the file through which programs compute, empty when EGL does not report it
  std::string uuid;          ///< "01234567-89ab-…" in lower case, empty when EGL does not report it
  bool is_software = false;
  bool tells_of_resets = false;  ///< the driver reports device resets; see Context::isLost()
  std::string problem;           ///< empty: the device works; otherwise the reason in one line
  std::string why;               ///< of the chosen device, in one line; else empty
  std::string advice;            ///< of the chosen device: why it is not the hardware, and what to do; else empty
  DeviceLimits limits;
};

/// The devices as `spindrift info` prints them.
struct GpuInfo {
  std::string egl_client_version;  ///< libEGL's client version without a display; empty when not available
  /// Every EGL device: hardware in EGL's order, each device once even if several vendor libraries list it, then one
  /// software rasteriser. Devices that cannot make an OpenGL 4.5 core context, are below the program's needs or fail a
  /// small probe program have `problem` set.
  std::vector<DeviceInfo> devices;
  std::optional<DeviceInfo> chosen;  ///< the device that `choice` selects; none when nothing works
  std::string why;                   ///< Context::why(), or the error when nothing works
  std::size_t shader_count = 0;      ///< entry points embedded in the program
};

/// Tries every device; takes some tenths of a second. Leaves the calling thread's current context unchanged.
GpuInfo collectInfo(const DeviceChoice& choice);

}  // namespace spindrift::gpu
