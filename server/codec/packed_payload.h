// Memory for the readers in decode/, which allocate none.
#pragma once

#include <algorithm>
#include <vector>

#include <spindrift/bitstream/decode/bit_source.h>
#include <spindrift/bitstream/decode/plane_reader.h>
#include <spindrift/core/bytes.h>

namespace spindrift::codec {

/// A payload followed by the zeros that its readers need. A payload longer than they accept becomes empty, and they
/// refuse it.
class PackedPayload {
 public:
  explicit PackedPayload(core::ByteView payload)
      : size_(payload.size() <= BitSource::kMaxBytes ? static_cast<std::uint32_t>(payload.size()) : 0),
        bytes_(size_ + BitSource::kSlackBytes) {
    std::copy_n(payload.data(), size_, bytes_.data());
  }
  [[nodiscard]] const std::uint8_t* data() const { return bytes_.data(); }
  [[nodiscard]] std::uint32_t size() const { return size_; }

 private:
  std::uint32_t size_;
  core::Bytes bytes_;
};

/// A PlaneRow with its memory.
class PlaneMemory {
 public:
  /// A change of size forgets the planes. 1 <= count.x, count.z <= PlaneRow::kMaxResolutionCount.
  void resize(core::CellCounts count) {
    if (row_.hasSize(count.x, count.z)) return;
    blocks_.resize(PlaneRow::bytesFor(count.x, count.z) / sizeof(Block));
    row_.place(blocks_.data()->bytes, count.x, count.z);
  }
  [[nodiscard]] PlaneRow& row() { return row_; }

 private:
  struct alignas(PlaneRow::kAlignment) Block {
    std::uint8_t bytes[PlaneRow::kAlignment];
  };
  std::vector<Block> blocks_;
  PlaneRow row_;
};

}  // namespace spindrift::codec
