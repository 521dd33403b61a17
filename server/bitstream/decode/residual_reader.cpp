#include <algorithm>
#include <array>
#include <cstring>

#include <spindrift/bitstream/decode/residual_reader.h>

#include "format/short_vectors.h"
#include "prefix_slots.h"

namespace spindrift::codec {
namespace {

/// Table entry of a code for several residuals at a time: the next bits hold one symbol or two.
struct JointSlot {
  std::uint8_t symbol = 0;
  std::uint8_t second = 0;
  std::uint8_t lengths = 0;  ///< of the first symbol in the lower four bits, of both in the upper four
  std::uint8_t advance = 0;  ///< number of residuals in these symbols
  [[nodiscard]] std::uint32_t firstLength() const { return lengths & 15u; }
  [[nodiscard]] std::uint32_t allLength() const { return lengths >> 4; }
};

/// A code for kCount residuals at a time, each of them one of kBase values around 0.
template <typename Word, std::uint32_t kBase>
struct JointCode {
  static constexpr std::size_t kCount = sizeof(Word) / sizeof(std::int16_t);
  static constexpr std::uint32_t kEscape = kFourEscape;
  static_assert(kFourEscape == kPairEscape);

  std::array<JointSlot, 1 << kMaxCodeBits> slots;

  [[gnu::noinline]] void assign(const PrefixSlots& code) {
    for (std::size_t window = 0; window < slots.size(); ++window) {
      const Slot first = code[window], second = code[window >> first.length];
      const std::uint32_t both = first.length + std::uint32_t{second.length};
      const bool has_second = both <= kMaxCodeBits && first.symbol != kEscape && second.symbol != kEscape;
      slots[window] = {first.symbol, has_second ? second.symbol : std::uint8_t{0},
                       static_cast<std::uint8_t>(first.length | (has_second ? both : first.length) << 4),
                       static_cast<std::uint8_t>(has_second ? 2 * kCount : kCount)};
    }
  }
  [[nodiscard]] JointSlot operator[](std::uint64_t window) const { return slots[window % slots.size()]; }

  /// The residuals of each symbol, 16 bits each.
  static constexpr std::array<Word, kEscape + 1> kMeanings = [] {
    std::array<Word, kEscape + 1> meanings{};
    for (std::uint32_t symbol = 0; symbol < kEscape; ++symbol) {
      for (std::uint32_t k = 0, rest = symbol; k < kCount; ++k, rest /= kBase)
        meanings[symbol] |= static_cast<Word>(static_cast<std::uint16_t>(rest % kBase - kBase / 2)) << (16 * k);
    }
    return meanings;
  }();
};
using FourCode = JointCode<std::uint64_t, 3>;
using PairCode = JointCode<std::uint32_t, 2 * kPairLargest + 1>;

[[gnu::noinline]] PrefixSlots slotsOf(std::string_view digits) {
  std::array<std::uint8_t, kMaxSymbolCount> lengths{};
  std::transform(digits.begin(), digits.end(), lengths.begin(), codeLengthOf);
  PrefixSlots slots;
  slots.assign(std::span(lengths).first(digits.size()));
  return slots;
}

constexpr std::uint32_t kFirstFourClass = kLastSparseClass + 1, kFirstPairClass = kLastFourClass + 1;
constexpr std::uint32_t kFirstSingleClass = kLastPairClass + 1;

}  // namespace

/// All fixed codes.
struct ResidualReader::Codes {
  std::array<FourCode, kFirstPairClass - kFirstFourClass> fours;
  std::array<PairCode, kFirstSingleClass - kFirstPairClass> pairs;
  std::array<PrefixSlots, kLastUnshiftedClass + 1 - kFirstSingleClass> singles;
  std::array<PrefixSlots, kClassStepLengths.size()> class_steps;

  Codes() {
    const std::string_view* lengths = kResidualLengths.data();
    for (FourCode& code : fours) code.assign(slotsOf(*lengths++));
    for (PairCode& code : pairs) code.assign(slotsOf(*lengths++));
    for (PrefixSlots& code : singles) code = slotsOf(*lengths++);
    std::transform(kClassStepLengths.begin(), kClassStepLengths.end(), class_steps.begin(), slotsOf);
  }
};

const ResidualReader::Codes& ResidualReader::codes() {
  static const Codes kCodes;
  return kCodes;
}

inline std::uint32_t ResidualReader::readClass(std::uint32_t left, std::uint32_t above) {
  const ClassExpectation expectation = expectClass(left, above);
  const std::uint32_t symbol = codes_.class_steps[expectation.code].get(bits_);
  if (symbol == 0) return 0;
  if (symbol == kClassEscape) return std::min(bits_.get(kRawClassBits), kResidualClassCount - 1);
  const int group_class = static_cast<int>(expectation.expected + symbol) - static_cast<int>(kClassReach) - 1;
  return static_cast<std::uint32_t>(std::clamp(group_class, 0, static_cast<int>(kResidualClassCount) - 1));
}

std::uint32_t ResidualReader::group(ResidualGroup& out, std::size_t count, std::uint32_t left, std::uint32_t above) {
  bits_.prepare();
  const std::uint32_t c = readClass(left, above);
  if (c == 0 && count == 1) {
    out.of[0] = 0;
    return c;
  }
  if (c <= kLastSparseClass || count < kGroupMaxCount) fill64(out.of.data(), 0);
  if (c == 0) return c;
  if (c <= kLastSparseClass) {
    for (std::uint32_t k = 0; k < c; ++k) {
      const std::uint32_t place = bits_.get(kPlaceBits);
      out.of[place] = bits_.get(1) != 0 ? -1 : 1;
    }
  } else if (c <= kLastFourClass) {
    joint(out.of.data(), count, codes_.fours[c - kFirstFourClass], kFourEscapeClass);
  } else if (c <= kLastPairClass) {
    joint(out.of.data(), count, codes_.pairs[c - kFirstPairClass], kPairEscapeClass);
  } else {
    singles(out.of.data(), count, c);
  }
  std::uint16_t sum = sum_;
  for (const std::int16_t r : out.of) sum = static_cast<std::uint16_t>(sum + r);
  sum_ = sum;
  return c;
}

template <typename Code>
void ResidualReader::joint(std::int16_t* out, std::size_t count, const Code& code, std::uint32_t escape_class) {
  constexpr std::size_t kCount = Code::kCount;
  constexpr int kLooks = 57 / kMaxCodeBits;
  const auto put = [out](std::size_t i, std::size_t symbol) {
    std::memcpy(out + i, &Code::kMeanings[symbol], kCount * sizeof *out);
  };
  BitSource in = bits_;
  for (std::size_t i = 0; i < count;) {
    std::uint64_t window = in.peek();
    bool is_escape = false;
    for (int look = 0; look < kLooks && i < count; ++look) {
      const JointSlot slot = code[window];
      is_escape = slot.symbol == Code::kEscape;
      // The last symbol of a group is decoded alone: a second one would belong to the next group.
      const bool is_last = i + kCount >= count;
      const std::uint32_t length = is_last ? slot.firstLength() : slot.allLength();
      in.take(length);
      if (is_escape) break;
      window >>= length;
      put(i, slot.symbol);
      if (!is_last) put(i + kCount, slot.second);
      i += is_last ? kCount : slot.advance;
    }
    if (is_escape) {
      bits_ = in;
      singles(out + i, kCount, escape_class);
      in = bits_;
      i += kCount;
    }
  }
  bits_ = in;
}

void ResidualReader::singles(std::int16_t* out, std::size_t count, std::uint32_t group_class) {
  const SingleCode single = singleCodeOf(group_class);
  const PrefixSlots& code = codes_.singles[single.coded_as - kFirstSingleClass];
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

}  // namespace spindrift::codec
