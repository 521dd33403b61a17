// What buffers can still take, so that a scene is refused before the system ends the program for its memory.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <glad/gl.h>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {
namespace {

constexpr std::uint64_t kBytesPerKiB = 1024;
constexpr std::uint64_t kBytesPerMiB = 1024 * kBytesPerKiB;

/// Returns the number behind `name` in a file of names and numbers, or the first number of the file if `name` is empty.
std::optional<std::uint64_t> numberIn(const std::string& file, const std::string& name = {}) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (!name.empty() && (!(words >> word) || word != name)) continue;
    std::uint64_t value = 0;
    if (words >> value) return value;
    if (name.empty()) break;
  }
  return std::nullopt;
}

/// Memory that the machine can give without ending a program, and that of the process's control group (version 2; its
/// caches of files can be dropped).
std::optional<std::uint64_t> freeOfMachine() {
  std::optional<std::uint64_t> out;
  if (const auto kib = numberIn("/proc/meminfo", "MemAvailable:")) out = *kib * kBytesPerKiB;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::")) continue;
    const std::string folder = "/sys/fs/cgroup" + line.substr(3) + "/";
    const auto limit = numberIn(folder + "memory.max"), used = numberIn(folder + "memory.current");
    if (!limit || !used) continue;
    const std::uint64_t free =
        *limit - std::min(*limit, *used) + numberIn(folder + "memory.stat", "inactive_file").value_or(0);
    out = std::min(out.value_or(free), free);
  }
  return out;
}

std::optional<std::uint64_t> freeOfHardware() {
  constexpr GLenum kFreeVideoMemory_KiB = 0x9049;  // GL_NVX_gpu_memory_info; Mesa's drivers have it, too
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i));
    if (name == nullptr || std::string_view(name) != "GL_NVX_gpu_memory_info") continue;
    GLint kib = 0;
    glGetIntegerv(kFreeVideoMemory_KiB, &kib);
    if (kib > 0) return static_cast<std::uint64_t>(kib) * kBytesPerKiB;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> Context::freeMemory_bytes() const {
  auto out = device_.is_software ? freeOfMachine() : freeOfHardware();
  if (checks_.memory_mib == 0) return out;
  const std::uint64_t limit_bytes = checks_.memory_mib * kBytesPerMiB;
  const std::uint64_t left_bytes = limit_bytes - std::min(limit_bytes, ledger_.buffer_bytes);
  return std::min(out.value_or(left_bytes), left_bytes);
}

}  // namespace spindrift::gpu
