#include "residual_codes.h"

#include <algorithm>
#include <iterator>

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

}  // namespace spindrift::codec
