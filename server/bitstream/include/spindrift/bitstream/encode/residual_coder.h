// Codes residuals in groups of up to 64 neighbours. The class of a group gives the size of its residuals, and each
// class has a fixed code. Nothing is adapted while coding, so the cost per group is the same in every frame.
//
// Classes: 0: all residuals are zero, nothing follows. c = 1..4: c residuals are 1 or -1, the rest 0; their positions
// follow. From 5 on the mean magnitude is about 2^((c - 13) / 2): residuals are coded in fours up to 9, in pairs up to
// 12, singly from 13 on; from 18 on the lowest (c - 16) / 2 bits of each are raw. A value larger than its code allows
// follows an escape.
#pragma once

#include <cstdint>

#include <spindrift/bitstream/encode/bit_stream.h>
#include <spindrift/bitstream/format/residual_format.h>

namespace spindrift::codec {

struct GroupWriter;

class ResidualEncoder {
 public:
  /// Returns a writer for up to group_count groups; hand it back with end().
  GroupWriter begin(std::size_t group_count);
  void end(const GroupWriter& writer);
  /// For bits outside the groups.
  BitWriter& bits() { return bits_; }
  /// Appends everything, with 16 bits of the sum of all residuals. The coder is empty afterwards.
  void finish(core::Bytes& out);

 private:
  BitWriter bits_;
  std::uint32_t residual_sum_ = 0;
};

}  // namespace spindrift::codec
