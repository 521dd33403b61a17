// What prediction left over, in groups of up to 64 neighbours: a group's class says how large its residuals are, and
// each class has a fixed code. Nothing is learned on the way, so groups of any frame cost the same work.
//
// Classes: 0, all are zero and nothing follows; c = 1..4, c of them are 1 or -1 and the rest 0, and their places
// follow; from 5 on mean magnitude about 2^((c - 13) / 2): fours together up to 9, pairs up to 12, one by one from 13
// on, and from 18 on the lowest (c - 16) / 2 bits of each stand raw. Whatever is larger than a code has values for
// follows an escape.
#pragma once

#include <cstdint>

#include "bit_stream.h"
#include "format/residual_format.h"

namespace spindrift::codec {

struct GroupWriter;

class ResidualEncoder {
 public:
  /// To write up to so many groups with; end() takes note of them.
  GroupWriter begin(std::size_t group_count);
  void end(const GroupWriter& writer);
  /// `left` and `above`: the classes of the groups before it in two directions, 0 where there is none; along a line
  /// both are the one before. Returns the group's class.
  std::uint32_t putGroup(const ResidualGroup& residuals, std::size_t count, std::uint32_t left, std::uint32_t above);
  /// For what stands beside the groups.
  BitWriter& bits() { return bits_; }
  /// Appends everything, and the sum of all residuals, 16 bits of it. Empty afterwards.
  void finish(core::Bytes& out);

 private:
  BitWriter bits_;
  std::uint32_t residual_sum_ = 0;
};

}  // namespace spindrift::codec
