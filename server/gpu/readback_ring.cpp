#include <algorithm>
#include <atomic>
#include <cassert>
#include <string>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/readback_ring.h>

#include "access_tracker.h"
#include "gl_errors.h"

namespace spindrift::gpu {

/// State shared by the views and the ring; it outlives the ring.
struct ReadbackRing::State {
  State(std::size_t bytes, std::size_t count)
      : slot_bytes(bytes), stride_bytes((bytes + 63) / 64 * 64), is_used(count) {}

  [[nodiscard]] std::size_t usedCount() const {
    const auto isSet = [](const std::atomic<bool>& used) { return used.load(std::memory_order_acquire); };
    return static_cast<std::size_t>(std::ranges::count_if(is_used, isSet));
  }
  /// Frees a slot after its last reader. Release order: the reader's accesses happen before the device writes here
  /// again.
  void free(std::size_t index) { is_used[index].store(false, std::memory_order_release); }

  const std::size_t slot_bytes;
  const std::size_t stride_bytes;
  std::vector<std::atomic<bool>> is_used;
  const std::byte* mapped = nullptr;
};

std::span<const std::uint32_t> ReadbackRing::Slot::words() const {
  // Slots start at multiples of 64 bytes, so the words are aligned.
  return {reinterpret_cast<const std::uint32_t*>(bytes_.data()), bytes_.size() / 4};
}

ReadbackRing::Recording::Recording(Recording&& other) noexcept
    : ring_(std::exchange(other.ring_, nullptr)), index_(other.index_), used_bytes_(other.used_bytes_) {}

ReadbackRing::Recording::~Recording() {
  if (ring_) ring_->state_->free(index_);
}

bool ReadbackRing::Recording::copyFrom(const Buffer& source, std::size_t source_offset_bytes, std::size_t size_bytes,
                                       std::size_t offset_bytes) {
  assert(ring_ && ring_->ctx_.isOwnedHere());
  const State& state = *ring_->state_;
  const auto fits = [size_bytes](std::size_t offset, std::size_t whole) {
    return offset <= whole && size_bytes <= whole - offset;
  };
  if (!fits(source_offset_bytes, source.sizeBytes()) || !fits(offset_bytes, state.slot_bytes)) return false;
  if (size_bytes == 0) return true;
  Context& ctx = ring_->ctx_;
  ctx.beforeUpdate(source.access(), nullptr);
  glCopyNamedBufferSubData(source.id(), ring_->buffer_id_, static_cast<GLintptr>(source_offset_bytes),
                           static_cast<GLintptr>(index_ * state.stride_bytes + offset_bytes),
                           static_cast<GLsizeiptr>(size_bytes));
  used_bytes_ = std::max(used_bytes_, offset_bytes + size_bytes);
  return true;
}

void ReadbackRing::Recording::submit(std::uint64_t tag) {
  assert(ring_ && ring_->ctx_.isOwnedHere());
  ring_->in_flight_.push_back({index_, tag, used_bytes_, Fence::insert(ring_->ctx_)});
  ring_ = nullptr;
}

core::Result<std::unique_ptr<ReadbackRing>> ReadbackRing::create(Context& ctx, std::string_view name,
                                                                 std::size_t slot_bytes, std::size_t slot_count) {
  assert(ctx.isOwnedHere());
  ctx.collectRetired();
  const std::string title = "readback ring \"" + std::string(name) + "\": ";
  if (slot_bytes == 0 || slot_count == 0) {
    return core::invalid(title + "needs at least 1 slot of at least 1 byte, not " + std::to_string(slot_count) +
                         " of " + std::to_string(slot_bytes));
  }
  auto state = std::make_shared<State>(slot_bytes, slot_count);
  const std::size_t size_bytes = state->stride_bytes * slot_count;
  clearOldErrors();  // the debug callback has counted them; the next error concerns this ring
  GLuint id = 0;
  glCreateBuffers(1, &id);
  constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  // The processor reads every byte: ask the driver to keep the storage in host memory.
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(size_bytes), nullptr, kMapping | GL_CLIENT_STORAGE_BIT);
  state->mapped =
      static_cast<const std::byte*>(glMapNamedBufferRange(id, 0, static_cast<GLsizeiptr>(size_bytes), kMapping));
  const GLenum error = isMemoryUsedUp(ctx, size_bytes) ? GL_OUT_OF_MEMORY : glGetError();
  if (!state->mapped || error == GL_OUT_OF_MEMORY) {
    glDeleteBuffers(1, &id);
    if (error == GL_OUT_OF_MEMORY) return outOfMemory(ctx, title.substr(0, title.size() - 2), size_bytes);
    return core::Error{core::ErrorCode::kInternal, title + "the device cannot map " + std::to_string(size_bytes) +
                                                       " bytes (OpenGL error " + std::to_string(error) +
                                                       "); make the scene smaller"};
  }
  glObjectLabel(GL_BUFFER, id, static_cast<GLsizei>(std::min<std::size_t>(name.size(), 200)), name.data());
  return std::unique_ptr<ReadbackRing>(new ReadbackRing(ctx, std::move(state), id, size_bytes));
}

ReadbackRing::ReadbackRing(Context& ctx, std::shared_ptr<State> state, std::uint32_t buffer_id, std::size_t size_bytes)
    : ctx_(ctx), state_(std::move(state)), buffer_id_(buffer_id), size_bytes_(size_bytes) {
  Ledger& ledger = ctx.ledgerEntry();
  ++ledger.buffer_count;
  ++ledger.buffers_made_count;
  ledger.buffer_bytes += size_bytes_;
}

ReadbackRing::~ReadbackRing() {
  assert(ctx_.isOwnedHere());
  for (const InFlight& flight : in_flight_) state_->free(flight.index);
  // Deleting a mapped buffer unmaps it, so storage that a view still uses must live until the view is dropped.
  ctx_.retire(buffer_id_, size_bytes_, [state = state_] { return state->usedCount() > 0; });
  ctx_.collectRetired();
}

std::optional<ReadbackRing::Recording> ReadbackRing::begin() {
  assert(ctx_.isOwnedHere());
  for (std::size_t i = 0; i < state_->is_used.size(); ++i) {
    if (state_->is_used[i].load(std::memory_order_acquire)) continue;
    state_->is_used[i].store(true, std::memory_order_relaxed);
    return Recording(*this, i);
  }
  ++refused_count_;
  return std::nullopt;
}

std::vector<std::shared_ptr<const ReadbackRing::Slot>> ReadbackRing::poll() {
  return wait(std::chrono::nanoseconds(0));
}

std::vector<std::shared_ptr<const ReadbackRing::Slot>> ReadbackRing::wait(std::chrono::nanoseconds limit) {
  assert(ctx_.isOwnedHere());
  ctx_.collectRetired();
  const auto end = std::chrono::steady_clock::now() + limit;
  std::vector<std::shared_ptr<const Slot>> out;
  // Fences are passed in order: after the first pending fence all others are pending.
  auto flight = in_flight_.begin();
  for (; flight != in_flight_.end(); ++flight) {
    const Fence::Status status = flight->fence.wait(end - std::chrono::steady_clock::now());
    if (status == Fence::Status::kPending) break;
    if (status == Fence::Status::kFailed) {
      ++lost_count_;
      state_->free(flight->index);
      continue;
    }
    const std::byte* const start = state_->mapped + flight->index * state_->stride_bytes;
    out.push_back({new Slot(flight->tag, std::span(start, flight->used_bytes)),
                   [state = state_, index = flight->index](const Slot* slot) {
                     delete slot;
                     state->free(index);
                   }});
  }
  in_flight_.erase(in_flight_.begin(), flight);
  return out;
}

std::size_t ReadbackRing::usedCount() const {
  return state_->usedCount();
}

}  // namespace spindrift::gpu
