// Private to this module.
#pragma once

#include <string>

#include <glad/gl.h>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Clears OpenGL's error flags, so that the next glGetError() reports only later calls. Bounded, because a context
/// whose device was lost may report an error forever.
inline void clearOldErrors() {
  constexpr int kMaxErrors = 32;  // OpenGL keeps one flag per kind of error, and there are eight kinds
  for (int i = 0; i < kMaxErrors && glGetError() != GL_NO_ERROR; ++i) {
  }
}

/// Returns whether Checks::memory_mib forbids another `size_bytes` of buffers.
inline bool isMemoryUsedUp(Context& ctx, std::size_t size_bytes) {
  constexpr std::uint64_t kBytesPerMiB = 1 << 20;
  const std::uint64_t limit_bytes = ctx.checks().memory_mib * kBytesPerMiB;
  return limit_bytes != 0 && ctx.ledger().buffer_bytes + size_bytes > limit_bytes;
}

/// Error kUnavailable of a buffer that the device has no memory for; `what` begins the line.
inline core::Error outOfMemory(Context& ctx, const std::string& what, std::size_t size_bytes) {
  return {core::ErrorCode::kUnavailable,
          what + ": the device has no memory for it: " + ctx.device().name + " refused " + std::to_string(size_bytes) +
              " bytes, besides " + std::to_string(ctx.ledger().buffer_bytes) +
              " bytes of this scene; make the scene smaller, or close other rooms and programs that use the device"};
}

}  // namespace spindrift::gpu
