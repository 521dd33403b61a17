#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <optional>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/context.h>

#include "access_tracker.h"
#include "compiled_program.h"
#include "device_selection.h"
#include "dispatch_times.h"
#include "egl_display.h"
#include "shader_folder.h"
#include "staging.h"

namespace spindrift::gpu {
namespace {

/// NVIDIA messages that are sent for every buffer or texture and say nothing about cost: framebuffer storage, placement
/// of a buffer (type "other", not "performance"), textures without a base level.
constexpr std::array<GLuint, 3> kNoisyIds = {131169, 131185, 131204};

/// Returns the driver's message in one line, without surrounding spaces and line ends.
std::string oneLine(std::string_view text) {
  std::string out(text.substr(0, 1000));
  std::ranges::replace(out, '\n', ' ');
  out.erase(out.find_last_not_of(" \r") + 1);
  return out;
}

void GLAD_API_PTR onDebugMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* message, const void* user) {
  if (std::find(kNoisyIds.begin(), kNoisyIds.end(), id) != kNoisyIds.end()) return;
  const std::string_view text(message, length < 0 ? std::char_traits<char>::length(message) : std::size_t(length));
  Context& ctx = *static_cast<Context*>(const_cast<void*>(user));
  // Program::create() returns compiler messages in its error, with file and line; do not log them twice.
  if (type == GL_DEBUG_TYPE_ERROR && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
    if (ctx.wasLost()) return;  // after a loss every call fails, and isLost() has logged the reason
    ctx.countError();
    spdlog::error("OpenGL error {}: {}", id, oneLine(text));
  } else if (severity == GL_DEBUG_SEVERITY_HIGH && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
    spdlog::warn("OpenGL message {}: {}", id, oneLine(text));
  } else {
    spdlog::debug("OpenGL message {}: {}", id, oneLine(text));
  }
}

}  // namespace

core::Result<std::unique_ptr<Context>> Context::create(const DeviceChoice& choice) {
  const auto checks = checksFromEnvironment();
  if (!checks) return checks.error();
  return create(choice, *checks);
}

core::Result<std::unique_ptr<Context>> Context::create(const DeviceChoice& choice, const Checks& checks) {
  auto chosen = selectDevice(egl::candidates(), choice, egl::openUsable, egl::close, Machine::real());
  if (!chosen) return chosen.error();
  const auto tuning = choice.tuning ? core::Result<TuningProfile>(*choice.tuning) : chosenTuning(chosen->info);
  if (!tuning) {
    egl::close(*chosen->handles);
    return tuning.error();
  }
  return std::unique_ptr<Context>(new Context(*std::move(chosen), checks, *tuning, choice.shader_folder));
}

Context::Context(egl::Attempt chosen, const Checks& checks, const TuningProfile& tuning,
                 const std::string& shader_folder)
    : egl_(std::make_unique<egl::Handles>(*chosen.handles)),
      device_(std::move(chosen.info)),
      checks_(checks),
      tuning_(tuning),
      accesses_(std::make_unique<AccessTracker>(checks.barriers)),
      staging_(std::make_unique<Staging>(*this)),
      // Shuffled programs and those under development are used once.
      programs_(std::make_unique<ProgramCache>(checks.shuffle_seed == 0 && shader_folder.empty()
                                                   ? ProgramStore::userFolder("programs")
                                                   : std::filesystem::path{})),
      dispatch_times_(checks.times ? std::make_unique<DispatchTimes>() : nullptr),
      shader_folder_(shader_folder.empty() ? nullptr : std::make_unique<ShaderFolder>(shader_folder)) {
  fence_delay_.set(checks.lag_fences_count);
  glEnable(GL_DEBUG_OUTPUT);
#ifndef NDEBUG
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that a breakpoint in the callback shows the call
#endif
  glDebugMessageCallback(onDebugMessage, this);
  if (!device_.tells_of_resets) {
    spdlog::info("{}: the driver does not report device resets; after a reset, restart the program", device_.name);
  }
}

Context::~Context() {
  // Restores the thread's current context afterwards.
  std::optional<egl::CurrentGuard> guard;
  if (!isOwnedHere()) guard.emplace();
  if (!makeCurrent()) {
    spdlog::error("OpenGL context destroyed while another thread uses it; its objects are not freed");
    (void)programs_.release();  // their destructors would need the context
    (void)staging_.release();
    (void)dispatch_times_.release();
    return;
  }
  dispatch_times_.reset();
  collectRetired();
  for (const Retired& retired : retired_) {
    spdlog::error("readback slots of buffer {} are still held while their context is destroyed", retired.buffer_id);
    glDeleteBuffers(1, &retired.buffer_id);
  }
  programs_.reset();
  staging_.reset();
  glFinish();
  glDebugMessageCallback(nullptr, nullptr);
  egl::close(*egl_);
  if (accesses_->hasFaults()) {
    spdlog::critical(
        "the barrier checker found faults (see above) that takeFaults() did not return: ending the process");
    std::abort();
  }
}

bool Context::makeCurrent() {
  return egl::makeCurrent(*egl_);
}

bool Context::isOwnedHere() const {
  return eglGetCurrentContext() == egl_->context;
}

void Context::release() {
  assert(isOwnedHere());
  egl::makeCurrent({egl_->display, EGL_NO_CONTEXT});
}

void Context::barrier(Barrier readers) {
  assert(isOwnedHere());
  accesses_->barrier(readers);
  issue(readers);
}

void Context::beforeDispatch(const ProgramUses& program, BufferAccess* indirect) {
  issue(accesses_->beforeDispatch(program, indirect));
}

void Context::beforeUpdate(BufferAccess* from, BufferAccess* to) {
  issue(accesses_->beforeUpdate(from, to));
}

void Context::issue(Barrier readers) {
  /// In the order of the bits of Barrier.
  constexpr std::array<GLbitfield, AccessTracker::kKindCount> kBits = {
      GL_SHADER_STORAGE_BARRIER_BIT, GL_TEXTURE_FETCH_BARRIER_BIT, GL_UNIFORM_BARRIER_BIT, GL_COMMAND_BARRIER_BIT,
      GL_BUFFER_UPDATE_BARRIER_BIT};
  GLbitfield bits = 0;
  for (std::size_t kind = 0; kind < kBits.size(); ++kind) {
    if ((static_cast<std::uint32_t>(readers) >> kind & 1u) != 0) bits |= kBits[kind];
  }
  if (bits == 0) return;
  glMemoryBarrier(bits);
  ++ledger_.barrier_count;
}

void Context::finish() {
  assert(isOwnedHere());
  glFinish();
}

void Context::reloadChangedShaders() {
  if (!shader_folder_) return;
  assert(isOwnedHere());
  if (const auto changed = shader_folder_->takeChanged(); !changed.empty()) programs_->reload(*this, changed);
}

bool Context::isLost() {
  if (wasLost()) return true;
  assert(isOwnedHere());
  if (!device_.tells_of_resets) return false;
  const GLenum status = glGetGraphicsResetStatus();
  if (status == GL_NO_ERROR) return false;
  if (!is_lost_.exchange(true)) {
    spdlog::error("{}: the device was reset ({}); everything on it is lost", device_.name,
                  status == GL_GUILTY_CONTEXT_RESET     ? "because of this program"
                  : status == GL_INNOCENT_CONTEXT_RESET ? "because of another program"
                                                        : "the driver does not know why");
  }
  return true;
}

std::vector<std::string> Context::takeFaults() {
  return accesses_->takeFaults();
}

void Context::poisonScratch() {
  assert(isOwnedHere());
  for (BufferAccess* const buffer : accesses_->buffers()) {
    if (!buffer->is_scratch) continue;
    beforeUpdate(nullptr, buffer);
    constexpr std::uint8_t kSetBits = 0xff;
    glClearNamedBufferData(buffer->buffer_id, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &kSetBits);
  }
}

std::vector<std::pair<std::uint32_t, std::string>> Context::lastingBuffers() const {
  std::vector<std::pair<std::uint32_t, std::string>> out;
  for (const BufferAccess* const buffer : accesses_->buffers())
    if (buffer->shader_write > 0 && !buffer->is_scratch) out.emplace_back(buffer->buffer_id, buffer->name);
  return out;
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
