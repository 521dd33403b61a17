// Copies data from the device to other threads without waiting: a persistently mapped ring of slots, each with a fence.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

/// begin() and poll() belong to the context's thread; finished slots may be read and dropped on any thread. A slot is
/// free again once its last reference is dropped. The ring may be destroyed while views are held; they stay valid until
/// the context is destroyed.
class ReadbackRing {
  struct State;

 public:
  /// A finished slot with the copied data, readable while a reference exists. Dropping it makes no OpenGL call.
  class Slot {
   public:
    Slot(std::uint64_t tag, std::span<const std::byte> bytes) : tag_(tag), bytes_(bytes) {}
    Slot(const Slot&) = delete;  // a copy would outlive the lease
    Slot& operator=(const Slot&) = delete;

    [[nodiscard]] std::uint64_t tag() const { return tag_; }
    /// Bytes of the slot up to the end of the last copied range.
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    /// Returns the same as 32-bit words; a tail of 1 to 3 bytes is left out.
    [[nodiscard]] std::span<const std::uint32_t> words() const;

   private:
    std::uint64_t tag_;
    std::span<const std::byte> bytes_;
  };

  /// A slot being filled. If it is dropped without submit(), the slot is free again. Must not outlive the ring.
  class Recording {
   public:
    ~Recording();
    Recording(Recording&& other) noexcept;
    Recording& operator=(Recording&&) = delete;

    /// Copies on the device; earlier shader writes are visible to the copy. Returns false and copies nothing when the
    /// data would not fit the slot or the source.
    [[nodiscard]] bool copyFrom(const Buffer& source, std::size_t source_offset_bytes, std::size_t size_bytes,
                                std::size_t offset_bytes);
    /// Inserts the fence and flushes the commands to the device; poll() returns the slot with this tag once it is done.
    void submit(std::uint64_t tag);

   private:
    friend class ReadbackRing;
    Recording(ReadbackRing& ring, std::size_t index) : ring_(&ring), index_(index) {}
    ReadbackRing* ring_;
    std::size_t index_;
    std::size_t used_bytes_ = 0;
  };

  /// Creates a ring. Error kInvalidInput for a slot of 0 bytes or a ring of 0 slots, kInternal when it cannot be
  /// mapped.
  static core::Result<std::unique_ptr<ReadbackRing>> create(Context& ctx, std::string_view name, std::size_t slot_bytes,
                                                            std::size_t slot_count);
  ~ReadbackRing();
  ReadbackRing(const ReadbackRing&) = delete;
  ReadbackRing& operator=(const ReadbackRing&) = delete;

  /// Returns a free slot, or nullopt when every slot is being filled, in flight or read; the caller then drops the
  /// frame.
  [[nodiscard]] std::optional<Recording> begin();
  /// Returns slots whose fence has been passed, in the order of submit(). Never waits. Slots that were in flight when
  /// the device was lost become free, are counted in lostCount() and are not returned.
  [[nodiscard]] std::vector<std::shared_ptr<const Slot>> poll();
  /// Returns what poll() does, but first waits at most `limit` for all slots in flight. On an asynchronous driver a
  /// fence may not be seen as passed at once, even when a later one is.
  [[nodiscard]] std::vector<std::shared_ptr<const Slot>> wait(std::chrono::nanoseconds limit);

  /// Returns the number of slots that are not free.
  [[nodiscard]] std::size_t usedCount() const;
  /// Returns the number of times that begin() returned nullopt.
  [[nodiscard]] std::uint64_t refusedCount() const { return refused_count_; }
  /// Returns the number of submitted slots whose data was lost with the device.
  [[nodiscard]] std::uint64_t lostCount() const { return lost_count_; }

 private:
  struct InFlight {
    std::size_t index;
    std::uint64_t tag;
    std::size_t used_bytes;
    Fence fence;
  };
  ReadbackRing(Context& ctx, std::shared_ptr<State> state, std::uint32_t buffer_id, std::size_t size_bytes);

  Context& ctx_;
  std::shared_ptr<State> state_;
  std::uint32_t buffer_id_;
  std::size_t size_bytes_;
  std::vector<InFlight> in_flight_;
  std::uint64_t refused_count_ = 0;
  std::uint64_t lost_count_ = 0;
};

}  // namespace spindrift::gpu
