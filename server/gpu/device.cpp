#include <cctype>
#include <charconv>
#include <filesystem>
#include <system_error>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/device.h>
#include <spindrift/gpu/embedded_shader.h>

#include "device_selection.h"
#include "egl_display.h"

namespace spindrift::gpu {

namespace {

/// Returns the UUID in lower case, without the "GPU-" of nvidia-smi; empty if the text is not a UUID.
std::string uuidOf(std::string_view text) {
  if (text.starts_with("GPU-")) text.remove_prefix(4);
  constexpr std::string_view kForm = "xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx";
  if (text.size() != kForm.size()) return {};
  std::string out;
  for (std::size_t k = 0; k < kForm.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    if (kForm[k] == 'x' ? std::isxdigit(c) == 0 : c != '-') return {};
    out += static_cast<char>(std::tolower(c));
  }
  return out;
}

}  // namespace

core::Result<DeviceChoice> parseDeviceChoice(std::string_view text) {
  constexpr int kMaxIndex = 1023;
  if (text == "auto") return DeviceChoice{DeviceChoice::Kind::kAuto, 0};
  if (text == "software") return DeviceChoice{DeviceChoice::Kind::kSoftware, 0};
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size() && index >= 0 && index <= kMaxIndex) {
    return DeviceChoice{DeviceChoice::Kind::kIndex, index};
  }
  if (text.starts_with('/')) {
    // Links such as those in /dev/dri/by-path keep their names when devices are added.
    std::error_code missing;
    const std::filesystem::path file = std::filesystem::canonical(text, missing);
    return DeviceChoice{.kind = DeviceChoice::Kind::kName, .name = missing ? std::string(text) : file.string()};
  }
  if (const std::string uuid = uuidOf(text); !uuid.empty())
    return DeviceChoice{.kind = DeviceChoice::Kind::kName, .name = uuid};
  return core::invalid("device \"" + std::string(text) + "\" is not auto, software, an index from 0 to " +
                       std::to_string(kMaxIndex) + ", a path or a UUID; see `spindrift info`");
}

GpuInfo collectInfo(const DeviceChoice& choice) {
  const egl::CurrentGuard guard;
  GpuInfo info;
  // Without a display EGL may refuse the query; an old libEGL has no client version.
  if (const char* version = eglQueryString(EGL_NO_DISPLAY, EGL_VERSION)) info.egl_client_version = version;
  info.devices = describeDevices(egl::candidates(), egl::openUsable, egl::close);
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
