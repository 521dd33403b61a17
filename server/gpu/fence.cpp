#include <algorithm>
#include <cassert>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

Fence Fence::insert(Context& ctx) {
  assert(ctx.isOwnedHere());
  Fence fence;
  fence.ctx_ = &ctx;
  fence.sync_.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  fence.status_ = fence.sync_ ? Status::kPending : Status::kFailed;
  fence.number_ = ctx.fenceDelay().insert();
  glFlush();  // without it a polled fence may never be passed
  return fence;
}

void Fence::DeleteSync::operator()(void* sync) const {
  glDeleteSync(static_cast<GLsync>(sync));
}

Fence::Status Fence::wait(std::chrono::nanoseconds timeout) {
  assert(status_ != Status::kPending || ctx_->isOwnedHere());
  // In slices, because some drivers notice a reset only between two waits.
  constexpr std::chrono::nanoseconds kSlice = std::chrono::milliseconds(100);
  if (status_ == Status::kPending && !ctx_->fenceDelay().passes(number_, timeout.count() > 0) && !ctx_->isLost()) {
    return status_;  // test mode: a slow device
  }
  std::chrono::nanoseconds left = std::max(timeout, std::chrono::nanoseconds(0));
  while (status_ == Status::kPending) {
    const std::chrono::nanoseconds slice = std::min(left, kSlice);
    const GLenum status = glClientWaitSync(static_cast<GLsync>(sync_.get()), GL_SYNC_FLUSH_COMMANDS_BIT,
                                           static_cast<GLuint64>(slice.count()));
    // Check the loss first: on a lost device a fence may report that it was passed, or that the wait failed.
    if (ctx_->isLost()) {
      status_ = Status::kFailed;
    } else if (status == GL_WAIT_FAILED) {
      spdlog::error("OpenGL refuses to wait for a fence (error {}); the work before it is lost", glGetError());
      ctx_->countError();
      status_ = Status::kFailed;
    } else if (status != GL_TIMEOUT_EXPIRED) {
      status_ = Status::kPassed;
    } else if (left <= slice) {
      break;
    }
    left -= slice;
  }
  if (status_ != Status::kPending) sync_.reset();
  return status_;
}

}  // namespace spindrift::gpu
