#include "residual_coder.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "residual_codes.h"

namespace spindrift::stream {
namespace {

/// Room for a class and 64 residuals behind an escape each.
constexpr std::size_t kGroupMaxBytes = 4 + kGroupMaxCount * 5;

struct Magnitudes {
  std::uint32_t sum = 0;
  int largest = 0;  ///< -32768 counts as 32767
  int signed_sum = 0;
};

#if defined(__SSE2__)

/// Sums of neighbouring products, four at a time.
__m128i sumsOfPairs(const std::int16_t* r, __m128i factors) {
  return _mm_madd_epi16(_mm_load_si128(reinterpret_cast<const __m128i*>(r)), factors);
}
int sumOf(__m128i fours) {
  fours = _mm_add_epi32(fours, _mm_shuffle_epi32(fours, _MM_SHUFFLE(1, 0, 3, 2)));
  fours = _mm_add_epi32(fours, _mm_shuffle_epi32(fours, _MM_SHUFFLE(2, 3, 0, 1)));
  return _mm_cvtsi128_si32(fours);
}

Magnitudes magnitudesOf(const ResidualGroup& residuals) {
  const __m128i ones = _mm_set1_epi16(1);
  __m128i sum = _mm_setzero_si128(), largest = sum, signed_sum = sum;
  for (std::size_t i = 0; i < kGroupMaxCount; i += 8) {
    const __m128i r = _mm_load_si128(reinterpret_cast<const __m128i*>(residuals.of.data() + i));
    const __m128i magnitude = _mm_max_epi16(r, _mm_subs_epi16(_mm_setzero_si128(), r));
    sum = _mm_add_epi32(sum, _mm_madd_epi16(magnitude, ones));
    signed_sum = _mm_add_epi32(signed_sum, _mm_madd_epi16(r, ones));
    largest = _mm_max_epi16(largest, magnitude);
  }
  largest = _mm_max_epi16(largest, _mm_shuffle_epi32(largest, _MM_SHUFFLE(1, 0, 3, 2)));
  largest = _mm_max_epi16(largest, _mm_shuffle_epi32(largest, _MM_SHUFFLE(2, 3, 0, 1)));
  largest = _mm_max_epi16(largest, _mm_srli_epi32(largest, 16));
  return {static_cast<std::uint32_t>(sumOf(sum)), static_cast<std::int16_t>(_mm_cvtsi128_si32(largest)),
          sumOf(signed_sum)};
}

/// One for each four residuals, all of them from -1 to 1; two apart.
void symbolsOfFours(const ResidualGroup& residuals, std::array<std::uint32_t, kGroupMaxCount / 2>& out) {
  const __m128i factors = _mm_setr_epi16(1, 3, 9, 27, 1, 3, 9, 27);
  for (std::size_t i = 0; i < kGroupMaxCount; i += 8) {
    const __m128i pairs = sumsOfPairs(residuals.of.data() + i, factors);
    const __m128i fours =
        _mm_add_epi32(_mm_add_epi32(pairs, _mm_srli_epi64(pairs, 32)), _mm_set1_epi32(1 + 3 + 9 + 27));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out.data() + i / 2), fours);
  }
}
/// One for each two, all of them from -4 to 4.
void symbolsOfPairs(const ResidualGroup& residuals, std::array<std::uint32_t, kGroupMaxCount / 2>& out) {
  const __m128i factors = _mm_setr_epi16(1, 9, 1, 9, 1, 9, 1, 9);
  for (std::size_t i = 0; i < kGroupMaxCount; i += 8) {
    const __m128i pairs = _mm_add_epi32(sumsOfPairs(residuals.of.data() + i, factors), _mm_set1_epi32(4 + 36));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out.data() + i / 2), pairs);
  }
}

#else

Magnitudes magnitudesOf(const ResidualGroup& residuals) {
  Magnitudes out;
  for (const std::int16_t r : residuals.of) {
    const int magnitude = std::min(std::abs(int{r}), 32767);
    out.sum += static_cast<std::uint32_t>(magnitude);
    out.largest = std::max(out.largest, magnitude);
    out.signed_sum += r;
  }
  return out;
}

void symbolsOfFours(const ResidualGroup& residuals, std::array<std::uint32_t, kGroupMaxCount / 2>& out) {
  for (std::size_t i = 0; i < kGroupMaxCount; i += 4) {
    const std::int16_t* r = residuals.of.data() + i;
    out[i / 2] = static_cast<std::uint32_t>(r[0] + 3 * r[1] + 9 * r[2] + 27 * r[3] + 40);
  }
}
void symbolsOfPairs(const ResidualGroup& residuals, std::array<std::uint32_t, kGroupMaxCount / 2>& out) {
  for (std::size_t i = 0; i < kGroupMaxCount; i += 2)
    out[i / 2] = static_cast<std::uint32_t>(residuals.of[i] + 9 * residuals.of[i + 1] + 40);
}

#endif

/// From class 5 on: the one whose mean magnitude is nearest to sum / count.
std::uint32_t meanClassOf(std::uint32_t sum, std::size_t count) {
  const std::uint64_t scaled = std::uint64_t{sum} * 1024 * kGroupMaxCount / count;  // 65536 * mean
  const int bits = static_cast<int>(std::bit_width(scaled)) - 1;
  const std::uint64_t thousands = scaled * 1000 >> bits;  // from 1000 to 1999
  const int doubled_log2 = 2 * (bits - 16) + (thousands > 1189 ? 1 : 0) + (thousands > 1682 ? 1 : 0);
  return static_cast<std::uint32_t>(std::clamp(doubled_log2 + 13, 5, static_cast<int>(kResidualClassCount) - 1));
}

std::uint32_t classOf(const Magnitudes& magnitudes, std::size_t count) {
  if (magnitudes.largest <= 1 && magnitudes.sum <= kLastSparseClass) return magnitudes.sum;
  return meanClassOf(magnitudes.sum, count);
}

void putClass(std::uint32_t group_class, std::uint32_t left, std::uint32_t above, BitCursor& out) {
  const ClassExpectation expectation = expectClass(left, above);
  const PrefixWriter& code = residualWriters().of_class_step[expectation.code];
  const std::uint32_t step = group_class + kClassReach + 1 - expectation.expected;
  if (group_class == 0) {
    code.put(0, out);
  } else if (step >= 1 && step < kClassEscape) {
    code.put(step, out);
  } else {
    code.put(kClassEscape, out);
    out.put(group_class, kRawClassBits);
  }
}

void putSingle(int r, const SingleCode& single, const PrefixWriter& code, BitCursor& out) {
  const int raised = r + (1 << single.shift >> 1);
  const auto symbol = static_cast<std::uint32_t>((raised >> single.shift) + single.largest);
  if (symbol < single.escape()) {
    code.put(symbol, out);
    out.put(static_cast<std::uint32_t>(raised) & ((1u << single.shift) - 1), single.shift);
  } else {
    code.put(single.escape(), out);
    out.put(static_cast<std::uint16_t>(r), kRawResidualBits);
  }
}

void putSingles(const std::int16_t* residuals, std::size_t count, std::uint32_t as_class, BitCursor& out) {
  const SingleCode single = singleCodeOf(as_class);
  const PrefixWriter& code = residualWriters().ofClass(single.coded_as);
  for (std::size_t i = 0; i < count; ++i) {
    putSingle(residuals[i], single, code, out);
    if (i % 2 != 0) out.flush();
  }
  out.flush();
}

/// Fours (Count 4) or pairs.
template <std::size_t Count, int Largest>
void putJoint(const ResidualGroup& residuals, std::size_t count, bool has_larger, const PrefixWriter& code,
              std::uint32_t escape_class, BitCursor& out) {
  static_assert(kFourEscape == kPairEscape);
  std::array<std::uint32_t, kGroupMaxCount / 2> symbols;
  if constexpr (Count == 4)
    symbolsOfFours(residuals, symbols);
  else
    symbolsOfPairs(residuals, symbols);
  if (!has_larger) {
    std::size_t i = 0;
    for (; i + 4 * Count <= count; i += 4 * Count) {
      for (std::size_t k = i; k < i + 4 * Count; k += Count) code.put(symbols[k / 2], out);
      out.flush();
    }
    for (; i < count; i += Count) code.put(symbols[i / 2], out);
    out.flush();
    return;
  }
  for (std::size_t i = 0; i < count; i += Count) {
    const std::int16_t* r = residuals.of.data() + i;
    if (std::any_of(r, r + Count, [](std::int16_t v) { return v > Largest || v < -Largest; })) {
      code.put(kFourEscape, out);
      out.flush();
      putSingles(r, Count, escape_class, out);
    } else {
      code.put(symbols[i / 2], out);
      out.flush();
    }
  }
}

/// At most kLastSparseClass residuals that are not 0.
void putPlaces(const ResidualGroup& residuals, BitCursor& out) {
  for (std::uint32_t begin = 0; begin < kGroupMaxCount; begin += 4) {
    std::uint64_t four;
    std::memcpy(&four, residuals.of.data() + begin, sizeof four);
    for (; four != 0;) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(four)) / 16;
      const bool is_below = residuals.of[begin + k] < 0;
      out.put((begin + k) | (is_below ? 1u << kPlaceBits : 0), kPlaceBits + 1);
      four &= ~(std::uint64_t{0xffff} << (16 * k));
    }
  }
  out.flush();
}

}  // namespace

std::uint32_t ResidualEncoder::putGroup(const ResidualGroup& residuals, std::size_t count, std::uint32_t left,
                                        std::uint32_t above) {
  assert(count >= 1 && count <= kGroupMaxCount);
  const Magnitudes magnitudes = magnitudesOf(residuals);
  const std::uint32_t c = classOf(magnitudes, count);
  BitCursor out = bits_.begin(kGroupMaxBytes);
  putClass(c, left, above, out);
  out.flush();
  if (c == 0) {
  } else if (c <= kLastSparseClass) {
    putPlaces(residuals, out);
  } else if (c <= kLastFourClass) {
    putJoint<4, 1>(residuals, count, magnitudes.largest > 1, residualWriters().ofClass(c), kFourEscapeClass, out);
  } else if (c <= kLastPairClass) {
    putJoint<2, kPairLargest>(residuals, count, magnitudes.largest > kPairLargest, residualWriters().ofClass(c),
                              kPairEscapeClass, out);
  } else {
    putSingles(residuals.of.data(), count, c, out);
  }
  bits_.end(out);
  residual_sum_ += static_cast<std::uint32_t>(magnitudes.signed_sum);
  return c;
}

void ResidualEncoder::finish(core::Bytes& out) {
  bits_.put(residual_sum_ & ((1u << kSumBits) - 1), kSumBits);
  residual_sum_ = 0;
  bits_.finish(out);
}

}  // namespace spindrift::stream
