#include "residual_reader.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "prefix_slots.h"

namespace spindrift::stream {
namespace {

constexpr std::size_t kFourCount = 81, kPairCount = 81;

/// Every fixed code, and what the symbols of the joint ones mean.
struct Codes {
  std::array<PrefixSlots, kResidualLengths.size()> of_class;  ///< [c - 5]
  std::array<PrefixSlots, kClassStepLengths.size()> of_class_step;
  std::array<std::uint64_t, kFourCount> fours{};  ///< four residuals of 16 bits
  std::array<std::uint32_t, kPairCount> pairs{};  ///< two

  Codes() {
    for (std::size_t k = 0; k < of_class.size(); ++k) assign(of_class[k], kResidualLengths[k]);
    for (std::size_t k = 0; k < of_class_step.size(); ++k) assign(of_class_step[k], kClassStepLengths[k]);
    for (std::uint32_t symbol = 0; symbol < kFourCount; ++symbol) {
      for (std::uint32_t k = 0, rest = symbol; k < 4; ++k, rest /= 3)
        fours[symbol] |= std::uint64_t{static_cast<std::uint16_t>(rest % 3 - 1)} << (16 * k);
    }
    for (std::uint32_t symbol = 0; symbol < kPairCount; ++symbol)
      pairs[symbol] = static_cast<std::uint16_t>(symbol % 9 - 4u) | (symbol / 9 - 4u) << 16;
  }
  [[nodiscard]] const PrefixSlots& ofClass(std::uint32_t c) const { return of_class[c - kLastSparseClass - 1]; }

 private:
  static void assign(PrefixSlots& slots, std::string_view digits) {
    std::array<std::uint8_t, kMaxSymbolCount> lengths{};
    std::transform(digits.begin(), digits.end(), lengths.begin(), codeLengthOf);
    slots.assign(std::span(lengths).first(digits.size()));
  }
};

const Codes& codes() {
  static const Codes kCodes;
  return kCodes;
}

}  // namespace

std::uint32_t ResidualReader::readClass(std::uint32_t left, std::uint32_t above) {
  const ClassExpectation expectation = expectClass(left, above);
  const std::uint32_t symbol = codes().of_class_step[expectation.code].get(bits_);
  if (symbol == 0) return 0;
  if (symbol == kClassEscape) return std::min(bits_.get(kRawClassBits), kResidualClassCount - 1);
  const int group_class = static_cast<int>(expectation.expected + symbol) - static_cast<int>(kClassReach) - 1;
  return static_cast<std::uint32_t>(std::clamp(group_class, 0, static_cast<int>(kResidualClassCount) - 1));
}

std::uint32_t ResidualReader::group(ResidualGroup& out, std::size_t count, std::uint32_t left, std::uint32_t above) {
  bits_.prepare();
  const std::uint32_t c = readClass(left, above);
  if (c <= kLastSparseClass || count < kGroupMaxCount) out.of.fill(0);
  if (c == 0) return c;
  if (c <= kLastSparseClass) {
    for (std::uint32_t k = 0; k < c; ++k) {
      const std::uint32_t place = bits_.get(kPlaceBits);
      out.of[place] = bits_.get(1) != 0 ? -1 : 1;
    }
  } else if (c <= kLastFourClass) {
    fours(out.of.data(), count, c);
  } else if (c <= kLastPairClass) {
    pairs(out.of.data(), count, c);
  } else {
    singles(out.of.data(), count, c);
  }
  std::uint16_t sum = sum_;
  for (const std::int16_t r : out.of) sum = static_cast<std::uint16_t>(sum + r);
  sum_ = sum;
  return c;
}

void ResidualReader::fours(std::int16_t* out, std::size_t count, std::uint32_t group_class) {
  const PrefixSlots& code = codes().ofClass(group_class);
  const std::uint64_t* const values = codes().fours.data();
  for (std::size_t i = 0; i < count;) {
    std::uint64_t window = bits_.peek();
    std::uint32_t taken = 0;
    std::size_t begin = i;
    for (int k = 0; k < 4 && i < count; ++k, i += 4) {
      const Slot slot = code[window];
      taken += slot.length;
      if (slot.symbol == kFourEscape) break;
      window >>= slot.length;
      std::memcpy(out + i, values + slot.symbol, sizeof *values);
    }
    bits_.take(taken);
    if (i < count && i - begin < 16) {
      singles(out + i, 4, kFourEscapeClass);
      i += 4;
    }
  }
}

void ResidualReader::pairs(std::int16_t* out, std::size_t count, std::uint32_t group_class) {
  const PrefixSlots& code = codes().ofClass(group_class);
  const std::uint32_t* const values = codes().pairs.data();
  for (std::size_t i = 0; i < count;) {
    std::uint64_t window = bits_.peek();
    std::uint32_t taken = 0;
    const std::size_t begin = i;
    for (int k = 0; k < 4 && i < count; ++k, i += 2) {
      const Slot slot = code[window];
      taken += slot.length;
      if (slot.symbol == kPairEscape) break;
      window >>= slot.length;
      std::memcpy(out + i, values + slot.symbol, sizeof *values);
    }
    bits_.take(taken);
    if (i < count && i - begin < 8) {
      singles(out + i, 2, kPairEscapeClass);
      i += 2;
    }
  }
}

void ResidualReader::singles(std::int16_t* out, std::size_t count, std::uint32_t group_class) {
  const SingleCode single = singleCodeOf(group_class);
  const PrefixSlots& code = codes().ofClass(single.coded_as);
  const std::uint32_t escape = single.escape();
  const std::int32_t lowest = -single.largest * (1 << single.shift) - (1 << single.shift >> 1);
  const std::uint32_t mask = (1u << single.shift) - 1;
  BitSource in = bits_;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t window = in.peek();
    const Slot slot = code[window];
    const auto raw = static_cast<std::uint32_t>(window >> slot.length);
    if (slot.symbol != escape) {
      out[i] =
          static_cast<std::int16_t>(lowest + static_cast<std::int32_t>(slot.symbol << single.shift | (raw & mask)));
      in.take(slot.length + single.shift);
    } else {
      out[i] = static_cast<std::int16_t>(raw);
      in.take(slot.length + kRawResidualBits);
    }
  }
  bits_ = in;
}

bool ResidualReader::isAtEnd() {
  bits_.prepare();
  return bits_.get(kSumBits) == sum_ && bits_.isAtEnd();
}

}  // namespace spindrift::stream
