#include <algorithm>
#include <iterator>

#include <spindrift/bitstream/encode/residual_coder.h>

#include "group_writer.h"

namespace spindrift::codec {
namespace {

PrefixWriter writerOf(std::string_view digits) {
  std::vector<std::uint8_t> lengths;
  std::ranges::transform(digits, std::back_inserter(lengths), codeLengthOf);
  return PrefixWriter(lengths);
}

}  // namespace

const ResidualWriters& residualWriters() {
  static const ResidualWriters kWriters = [] {
    ResidualWriters writers;
    for (const std::string_view digits : kResidualLengths) writers.of_class.push_back(writerOf(digits));
    for (const std::string_view digits : kClassStepLengths) writers.of_class_step.push_back(writerOf(digits));
    return writers;
  }();
  return kWriters;
}

GroupWriter ResidualEncoder::begin(std::size_t group_count) {
  return {residualWriters(), bits_.begin(group_count * GroupWriter::kGroupMaxBytes)};
}

void ResidualEncoder::end(const GroupWriter& writer) {
  bits_.end(writer.out);
  residual_sum_ += writer.residual_sum;
}

void ResidualEncoder::finish(core::Bytes& out) {
  bits_.put(residual_sum_ & ((1u << kSumBits) - 1), kSumBits);
  residual_sum_ = 0;
  bits_.finish(out);
}

}  // namespace spindrift::codec
