#include <algorithm>
#include <cassert>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

Fence Fence::insert(Context& ctx) {
  assert(ctx.isOwnedHere());
  Fence fence;
  fence.ctx_ = &ctx;
  fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  fence.state_ = fence.sync_ ? FenceState::kPending : FenceState::kLost;
  fence.held_polls_count_ = ctx.heldPollsCount();
  glFlush();  // without it a fence that is only polled may never be passed
  return fence;
}

Fence::~Fence() {
  if (sync_) glDeleteSync(static_cast<GLsync>(sync_));
}

Fence::Fence(Fence&& other) noexcept
    : ctx_(other.ctx_),
      sync_(std::exchange(other.sync_, nullptr)),
      state_(std::exchange(other.state_, FenceState::kPassed)),
      held_polls_count_(std::exchange(other.held_polls_count_, 0)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
  // What this held goes with the temporary.
  Fence moved(std::move(other));
  std::swap(ctx_, moved.ctx_);
  std::swap(sync_, moved.sync_);
  std::swap(state_, moved.state_);
  std::swap(held_polls_count_, moved.held_polls_count_);
  return *this;
}

FenceState Fence::poll() {
  if (state_ == FenceState::kPending && held_polls_count_ > 0 && !ctx_->isLost()) {
    --held_polls_count_;
    return FenceState::kPending;
  }
  return wait(std::chrono::nanoseconds(0));
}

FenceState Fence::wait(std::chrono::nanoseconds limit) {
  assert(state_ != FenceState::kPending || ctx_->isOwnedHere());
  // In slices, because a driver may notice a reset only between two waits.
  constexpr std::chrono::nanoseconds kSlice = std::chrono::milliseconds(100);
  std::chrono::nanoseconds left = std::max(limit, std::chrono::nanoseconds(0));
  while (state_ == FenceState::kPending) {
    const std::chrono::nanoseconds slice = std::min(left, kSlice);
    const GLenum status =
        glClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT, static_cast<GLuint64>(slice.count()));
    // The loss comes first: on a lost device a fence reports that it was passed, or that the wait failed.
    if (ctx_->isLost()) {
      finish(FenceState::kLost);
    } else if (status == GL_WAIT_FAILED) {
      spdlog::error("OpenGL refuses to wait for a fence (error {}); what it stands for is lost", glGetError());
      ctx_->countError();
      finish(FenceState::kLost);
    } else if (status != GL_TIMEOUT_EXPIRED) {
      finish(FenceState::kPassed);
    } else if (left <= slice) {
      break;
    }
    left -= slice;
  }
  return state_;
}

void Fence::finish(FenceState state) {
  glDeleteSync(static_cast<GLsync>(sync_));
  sync_ = nullptr;
  state_ = state;
}

}  // namespace spindrift::gpu
