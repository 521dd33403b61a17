#include <cassert>
#include <utility>

#include <glad/gl.h>

#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

Fence Fence::insert(Context& ctx) {
  assert(ctx.isOwnedHere());
  Fence out;
  out.ctx_ = &ctx;
  out.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  out.number_ = ctx.fenceDelay().insert();
  glFlush();  // without it a fence may never pass, because asking does not wait
  return out;
}

Fence::~Fence() {
  if (!sync_) return;
  assert(ctx_->isOwnedHere());
  glDeleteSync(static_cast<GLsync>(sync_));
}

Fence::Fence(Fence&& other) noexcept
    : ctx_(other.ctx_), sync_(std::exchange(other.sync_, nullptr)), number_(other.number_) {}

Fence& Fence::operator=(Fence&& other) noexcept {
  // What this held goes with the temporary.
  Fence moved(std::move(other));
  std::swap(ctx_, moved.ctx_);
  std::swap(sync_, moved.sync_);
  std::swap(number_, moved.number_);
  return *this;
}

Fence::Status Fence::wait(std::chrono::nanoseconds timeout) {
  assert(sync_ && ctx_->isOwnedHere());
  if (!ctx_->fenceDelay().passes(number_, timeout.count() > 0)) return Status::kPending;
  switch (glClientWaitSync(static_cast<GLsync>(sync_), 0, static_cast<GLuint64>(timeout.count()))) {
    case GL_ALREADY_SIGNALED:
    case GL_CONDITION_SATISFIED:
      return Status::kPassed;
    case GL_TIMEOUT_EXPIRED:
      return Status::kPending;
    default:
      return Status::kFailed;
  }
}

}  // namespace spindrift::gpu
