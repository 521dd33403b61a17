// Raw bits, least significant first: what an entropy coder would not make smaller.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::stream {

class BitWriter {
 public:
  /// The low `bit_count` bits of value; the others have to be 0. bit_count <= 32.
  void put(std::uint32_t value, int bit_count) {
    pending_ |= std::uint64_t{value} << pending_count_;
    pending_count_ += bit_count;
    if (pending_count_ < 32) return;
    append(4);
    pending_ >>= 32;
    pending_count_ -= 32;
  }
  /// What was written, filled up with zero bits to whole bytes. The writer is empty afterwards.
  core::Bytes take() {
    append((pending_count_ + 7) / 8);
    pending_ = 0;
    pending_count_ = 0;
    return std::exchange(bytes_, {});
  }

 private:
  void append(int byte_count) {
    for (int i = 0; i < byte_count; ++i) bytes_.push_back(static_cast<std::uint8_t>(pending_ >> (8 * i)));
  }

  core::Bytes bytes_;
  std::uint64_t pending_ = 0;
  int pending_count_ = 0;
};

/// Reads what BitWriter wrote. Beyond the end there are zeros, and isAtEnd() is false then.
class BitReader {
 public:
  explicit BitReader(core::ByteView bytes) : bytes_(bytes) {}

  /// bit_count <= 32.
  std::uint32_t get(int bit_count) {
    while (available_count_ < bit_count) {
      const std::uint64_t byte = at_ < bytes_.size() ? bytes_[at_] : 0;
      ++at_;
      pending_ |= byte << available_count_;
      available_count_ += 8;
    }
    const auto value = static_cast<std::uint32_t>(pending_ & ((std::uint64_t{1} << bit_count) - 1));
    pending_ >>= bit_count;
    available_count_ -= bit_count;
    return value;
  }
  /// Whether everything but the filling was read.
  [[nodiscard]] bool isAtEnd() const { return at_ == bytes_.size() && pending_ == 0; }

 private:
  core::ByteView bytes_;
  std::size_t at_ = 0;
  std::uint64_t pending_ = 0;
  int available_count_ = 0;
};

}  // namespace spindrift::stream
