// Reads what codec/residual_coder wrote: residuals in groups of up to 64, with the fixed code of each group's class.
#pragma once

#include <cstdint>

#include "bit_source.h"
#include "format/residual_format.h"

namespace spindrift::codec {

class ResidualReader {
 public:
  /// As of a BitSource.
  ResidualReader(const std::uint8_t* bytes, std::uint32_t byte_count) : codes_(codes()), bits_(bytes, byte_count) {}

  /// The next `count` residuals; those behind are 0 in what an encoder wrote. `left` and `above`: the classes of the
  /// groups before it, below kResidualClassCount. Returns the group's class.
  std::uint32_t group(ResidualGroup& out, std::size_t count, std::uint32_t left, std::uint32_t above);
  /// For what stands beside the groups.
  BitSource& bits() { return bits_; }
  /// To be called last. Whether the sum fits and nothing is left over: else the bytes are damaged.
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
