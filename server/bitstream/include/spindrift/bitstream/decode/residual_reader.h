// Decodes residuals written by codec/residual_coder: groups of up to 64, each with the fixed code of its class.
#pragma once

#include <cstdint>

#include <spindrift/bitstream/decode/bit_source.h>
#include <spindrift/bitstream/format/residual_format.h>

namespace spindrift::codec {

class ResidualReader {
 public:
  /// Same requirements as BitSource.
  ResidualReader(const std::uint8_t* bytes, std::uint32_t byte_count) : codes_(codes()), bits_(bytes, byte_count) {}

  /// Reads the next `count` residuals; the others of the group are 0 in valid streams. `left` and `above`: the classes
  /// of the neighbouring groups, below kResidualClassCount. Returns the group's class.
  std::uint32_t group(ResidualGroup& out, std::size_t count, std::uint32_t left, std::uint32_t above);
  /// For bits outside the groups.
  BitSource& bits() { return bits_; }
  /// Call it last. Returns whether the sum is right and no bits are left; otherwise the bytes are damaged.
  bool isAtEnd();

 private:
  struct Codes;
  static const Codes& codes();

  std::uint32_t readClass(std::uint32_t left, std::uint32_t above);
  template <typename Code>
  void joint(std::int16_t* out, std::size_t count, const Code& code, std::uint32_t escape_class);
  void singles(std::int16_t* out, std::size_t count, std::uint32_t group_class);

  const Codes& codes_;
  BitSource bits_;
  std::uint16_t sum_ = 0;  ///< of all residuals
};

}  // namespace spindrift::codec
