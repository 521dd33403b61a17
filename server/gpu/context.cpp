#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/context.h>

#include "egl_display.h"

namespace spindrift::gpu {
namespace {

/// NVIDIA's remarks on where a buffer lives, on shader variants and on transfers: said for every buffer or frame.
constexpr std::array<GLuint, 5> kNoisyIds = {131154, 131169, 131185, 131204, 131218};

void GLAD_API_PTR onDebugMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* message, const void* user) {
  if (std::find(kNoisyIds.begin(), kNoisyIds.end(), id) != kNoisyIds.end()) return;
  const std::string_view text(message, length < 0 ? std::char_traits<char>::length(message) : std::size_t(length));
  // What the compiler says is in Program::create()'s error, with the file and line; once is enough.
  if (type == GL_DEBUG_TYPE_ERROR && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
    static_cast<Context*>(const_cast<void*>(user))->countError();
    spdlog::error("OpenGL error {}: {}", id, text);
  } else if (severity == GL_DEBUG_SEVERITY_HIGH && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
    spdlog::warn("OpenGL message {}: {}", id, text);
  } else {
    spdlog::debug("OpenGL message {}: {}", id, text);
  }
}

std::string label(const DeviceInfo& info) {
  return info.index >= 0 ? "device " + std::to_string(info.index) + " (" + info.name + ")" : info.name;
}

struct Choice {
  egl::Handles handles;
  DeviceInfo info;
  std::string why;
};

/// Tries what `choice` allows, in order; the handles of the first that works, or an error naming all that did not.
core::Result<Choice> choose(const DeviceChoice& choice) {
  using Kind = DeviceChoice::Kind;
  const std::vector<egl::Candidate> candidates = egl::candidates();
  const auto hardware_count =
      std::count_if(candidates.begin(), candidates.end(), [](const auto& c) { return !c.is_software; });
  if (choice.kind == Kind::kIndex && choice.index >= hardware_count) {
    return core::Error{core::ErrorCode::kNoDevice, "device " + std::to_string(choice.index) +
                                                       " does not exist: EGL lists " + std::to_string(hardware_count) +
                                                       " hardware devices; use auto or software, see `spindrift info`"};
  }
  std::string failures;
  for (const egl::Candidate& candidate : candidates) {
    if (choice.kind == Kind::kIndex && candidate.index != choice.index) continue;
    if (choice.kind == Kind::kSoftware && !candidate.is_software) continue;
    egl::Attempt attempt = egl::open(candidate);
    DeviceInfo& info = attempt.info;
    if (attempt.handles && choice.kind == Kind::kSoftware && !info.is_software) {
      egl::close(*attempt.handles);
      attempt.handles.reset();
      info.problem = "picks " + info.name + "; set LIBGL_ALWAYS_SOFTWARE=1";
    }
    if (attempt.handles) {
      std::string why = label(info) + ": ";
      if (choice.kind == Kind::kIndex) {
        why += "asked for by index";
      } else if (choice.kind == Kind::kSoftware) {
        why += "software asked for";
      } else if (!info.is_software) {
        why += "first hardware device that makes an OpenGL 4.5 core context";
      } else if (hardware_count == 0) {
        why += "software, because EGL lists no hardware device";
      } else {
        why += "software, because no hardware device works";
      }
      if (!failures.empty()) why += "; not used: " + failures;
      return Choice{*attempt.handles, std::move(info), std::move(why)};
    }
    if (!failures.empty()) failures += ", ";
    failures += label(info) + ": " + info.problem;
  }
  return core::Error{core::ErrorCode::kNoDevice,
                     "no usable EGL device with OpenGL 4.5 (" + failures +
                         "); install your GPU's driver with EGL, or Mesa's software rasteriser: "
                         "apt install libegl1 libegl-mesa0 libgl1-mesa-dri"};
}

GLbitfield barrierBits(Barrier readers) {
  const auto mask = static_cast<std::uint32_t>(readers);
  const auto has = [mask](Barrier b) { return (mask & static_cast<std::uint32_t>(b)) != 0; };
  GLbitfield bits = 0;
  if (has(Barrier::kStorage)) bits |= GL_SHADER_STORAGE_BARRIER_BIT;
  if (has(Barrier::kTexel)) bits |= GL_TEXTURE_FETCH_BARRIER_BIT;
  if (has(Barrier::kUniform)) bits |= GL_UNIFORM_BARRIER_BIT;
  if (has(Barrier::kIndirect)) bits |= GL_COMMAND_BARRIER_BIT;
  if (has(Barrier::kBufferUpdate)) bits |= GL_BUFFER_UPDATE_BARRIER_BIT;
  return bits;
}

}  // namespace

struct Context::Egl {
  egl::Handles handles;
};

core::Result<std::unique_ptr<Context>> Context::create(const DeviceChoice& choice) {
  core::Result<Choice> chosen = choose(choice);
  if (!chosen) return chosen.error();
  return std::unique_ptr<Context>(
      new Context(std::make_unique<Egl>(Egl{chosen->handles}), std::move(chosen->info), std::move(chosen->why)));
}

Context::Context(std::unique_ptr<Egl> egl, DeviceInfo device, std::string why)
    : egl_(std::move(egl)), device_(std::move(device)), why_(std::move(why)) {
  glEnable(GL_DEBUG_OUTPUT);
#ifndef NDEBUG
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that a breakpoint in the callback shows the call
#endif
  glDebugMessageCallback(onDebugMessage, this);
}

Context::~Context() {
  // Another context of this thread stays current afterwards.
  std::optional<egl::CurrentGuard> guard;
  if (!isOwnedHere()) guard.emplace();
  if (!makeCurrent()) {
    spdlog::error("OpenGL context destroyed while another thread uses it; its objects are not freed");
    return;
  }
  collectRetired();
  for (const Retired& retired : retired_) {
    spdlog::error("readback slots of buffer {} are still held while their context goes", retired.buffer_id);
    glDeleteBuffers(1, &retired.buffer_id);
  }
  glFinish();
  glDebugMessageCallback(nullptr, nullptr);
  egl::close(egl_->handles);
}

bool Context::makeCurrent() {
  return egl::makeCurrent(egl_->handles);
}

bool Context::isOwnedHere() const {
  return eglGetCurrentContext() == egl_->handles.context;
}

void Context::release() {
  assert(isOwnedHere());
  egl::makeCurrent({egl_->handles.display, EGL_NO_CONTEXT});
}

void Context::barrier(Barrier readers) {
  assert(isOwnedHere());
  glMemoryBarrier(barrierBits(readers));
}

void Context::flush() {
  assert(isOwnedHere());
  glFlush();
}

void Context::finish() {
  assert(isOwnedHere());
  glFinish();
}

void Context::retire(std::uint32_t buffer_id, std::size_t size_bytes, std::function<bool()> in_use) {
  assert(isOwnedHere());
  retired_.push_back({buffer_id, size_bytes, std::move(in_use)});
}

void Context::collectRetired() {
  assert(isOwnedHere());
  std::erase_if(retired_, [this](const Retired& retired) {
    if (retired.in_use()) return false;
    glDeleteBuffers(1, &retired.buffer_id);
    --ledger_.buffer_count;
    ledger_.buffer_bytes -= retired.size_bytes;
    return true;
  });
}

}  // namespace spindrift::gpu
