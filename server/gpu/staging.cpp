#include "staging.h"

#include <algorithm>
#include <cstring>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include "gl_errors.h"

namespace spindrift::gpu {

Staging::~Staging() {
  // Deleting a mapped buffer unmaps it.
  if (up_.id != 0) glDeleteBuffers(1, &up_.id);
  if (down_.id != 0) glDeleteBuffers(1, &down_.id);
}

bool Staging::prepare(Ring& ring, bool is_for_upload) {
  if (ring.mapped) return true;
  clearOldErrors();
  const auto size_bytes = static_cast<GLsizeiptr>(kPartBytes * kPartCount);
  const GLbitfield access =
      (is_for_upload ? GL_MAP_WRITE_BIT : GL_MAP_READ_BIT) | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glCreateBuffers(1, &ring.id);
  glNamedBufferStorage(ring.id, size_bytes, nullptr, access | GL_CLIENT_STORAGE_BIT);
  ring.mapped = static_cast<std::byte*>(glMapNamedBufferRange(ring.id, 0, size_bytes, access));
  if (ring.mapped) return true;
  if (!ctx_.isLost()) {
    spdlog::error("the device cannot map {} bytes for {} (OpenGL error {})", size_bytes,
                  is_for_upload ? "uploads" : "downloads", glGetError());
    ctx_.countError();
  }
  glDeleteBuffers(1, &ring.id);
  ring.id = 0;
  return false;
}

bool Staging::await(Fence& fence, const char* what) {
  const Fence::Status state = fence.wait(kLimit);
  if (state == Fence::Status::kPassed) return true;
  if (state == Fence::Status::kPending) {
    spdlog::error("the device did not {} within {} s", what, kLimit.count());
    ctx_.countError();
  }
  return false;
}

void Staging::upload(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<const std::byte> bytes) {
  if (!prepare(up_, true)) return;
  while (!bytes.empty()) {
    if (up_used_bytes_ == kPartBytes) {
      up_fences_[up_part_] = Fence::insert(ctx_);
      const std::size_t next = (up_part_ + 1) % kPartCount;
      // After a failure the part stays full, and the next upload tries again.
      if (!await(up_fences_[next], "take an upload")) return;
      up_part_ = next;
      up_used_bytes_ = 0;
    }
    const std::size_t now_bytes = std::min(bytes.size(), kPartBytes - up_used_bytes_);
    const std::size_t at = up_part_ * kPartBytes + up_used_bytes_;
    std::memcpy(up_.mapped + at, bytes.data(), now_bytes);
    glCopyNamedBufferSubData(up_.id, buffer_id, static_cast<GLintptr>(at), static_cast<GLintptr>(offset_bytes),
                             static_cast<GLsizeiptr>(now_bytes));
    // Most devices copy word by word: keep the next copy aligned.
    up_used_bytes_ = std::min(kPartBytes, (up_used_bytes_ + now_bytes + 15) / 16 * 16);
    offset_bytes += now_bytes;
    bytes = bytes.subspan(now_bytes);
  }
}

void Staging::download(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<std::byte> bytes) {
  bool is_done = prepare(down_, false);
  std::span<std::byte> left = bytes;
  while (is_done && !left.empty()) {
    const std::size_t now_bytes = std::min(left.size(), kPartBytes * kPartCount);
    glCopyNamedBufferSubData(buffer_id, down_.id, static_cast<GLintptr>(offset_bytes), 0,
                             static_cast<GLsizeiptr>(now_bytes));
    Fence fence = Fence::insert(ctx_);
    is_done = await(fence, "answer a download");
    if (!is_done) break;
    std::memcpy(left.data(), down_.mapped, now_bytes);
    offset_bytes += now_bytes;
    left = left.subspan(now_bytes);
  }
  if (!is_done) std::ranges::fill(bytes, std::byte{0});
}

}  // namespace spindrift::gpu
