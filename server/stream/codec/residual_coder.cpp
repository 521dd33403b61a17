#include "residual_coder.h"

#include <algorithm>

#include "group_writer.h"
#include "residual_codes.h"

namespace spindrift::stream {
namespace {

constexpr std::uint32_t kPlaceBits = GroupWriter::kPlaceBits;

void getSingles(std::int16_t* residuals, std::size_t count, std::uint32_t as_class, BitReader& in) {
  const SingleCode single = singleCodeOf(as_class);
  const PrefixReader& code = residualReaders().ofClass(single.coded_as);
  const int half = 1 << single.shift >> 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t symbol = code.get(in);
    residuals[i] = symbol == single.escape()
                       ? static_cast<std::int16_t>(in.get(kRawResidualBits))
                       : static_cast<std::int16_t>((static_cast<int>(symbol) - single.largest) * (1 << single.shift) -
                                                   half + static_cast<int>(in.get(single.shift)));
  }
}

template <std::size_t Count, int Largest>
void getJoint(ResidualGroup& residuals, std::size_t count, const PrefixReader& code, std::uint32_t escape_class,
              BitReader& in) {
  for (std::size_t i = 0; i < count; i += Count) {
    std::uint32_t symbol = code.get(in);
    std::int16_t* r = residuals.of.data() + i;
    if (symbol == kFourEscape) {
      getSingles(r, Count, escape_class, in);
    } else {
      for (std::size_t k = 0; k < Count; ++k, symbol /= 2 * Largest + 1)
        r[k] = static_cast<std::int16_t>(static_cast<int>(symbol % (2 * Largest + 1)) - Largest);
    }
  }
}

std::uint32_t getClass(std::uint32_t left, std::uint32_t above, BitReader& in) {
  const ClassExpectation expectation = expectClass(left, above);
  const std::uint32_t symbol = residualReaders().of_class_step[expectation.code].get(in);
  if (symbol == 0) return 0;
  if (symbol == kClassEscape) return std::min(in.get(kRawClassBits), kResidualClassCount - 1);
  const int group_class = static_cast<int>(expectation.expected + symbol) - static_cast<int>(kClassReach) - 1;
  return static_cast<std::uint32_t>(std::clamp(group_class, 0, static_cast<int>(kResidualClassCount) - 1));
}

}  // namespace

std::uint32_t ResidualEncoder::putGroup(const ResidualGroup& residuals, std::size_t count, std::uint32_t left,
                                        std::uint32_t above) {
  GroupWriter writer = begin(1);
  const std::uint32_t group_class = writer.putGroup(residuals, count, left, above);
  end(writer);
  return group_class;
}

GroupWriter ResidualEncoder::begin(std::size_t group_count) {
  return {residualWriters(), bits_.begin(group_count * GroupWriter::kGroupMaxBytes)};
}

void ResidualEncoder::end(const GroupWriter& writer) {
  bits_.end(writer.out);
  residual_sum_ += writer.residual_sum;
}

void ResidualEncoder::finish(core::Bytes& out) {
  bits_.put(residual_sum_ & ((1u << ResidualDecoder::kSumBits) - 1), ResidualDecoder::kSumBits);
  residual_sum_ = 0;
  bits_.finish(out);
}

std::uint32_t ResidualDecoder::getGroup(ResidualGroup& residuals, std::size_t count, std::uint32_t left,
                                        std::uint32_t above) {
  const std::uint32_t c = getClass(left, above, bits_);
  if (c <= kLastSparseClass) {
    residuals.of.fill(0);
    for (std::uint32_t k = 0; k < c; ++k) {
      const std::uint32_t place = bits_.get(kPlaceBits);
      residuals.of[place] = bits_.get(1) != 0 ? -1 : 1;
    }
  } else if (c <= kLastFourClass) {
    getJoint<4, 1>(residuals, count, residualReaders().ofClass(c), kFourEscapeClass, bits_);
  } else if (c <= kLastPairClass) {
    getJoint<2, kPairLargest>(residuals, count, residualReaders().ofClass(c), kPairEscapeClass, bits_);
  } else {
    getSingles(residuals.of.data(), count, c, bits_);
  }
  const std::size_t padded =
      c > kLastFourClass ? c > kLastPairClass ? count : (count + 1) / 2 * 2 : (count + 3) / 4 * 4;
  const std::size_t end = c <= kLastSparseClass ? kGroupMaxCount : padded;
  for (std::size_t i = 0; i < end; ++i) residual_sum_ += static_cast<std::uint32_t>(int{residuals.of[i]});
  return c;
}

}  // namespace spindrift::stream
