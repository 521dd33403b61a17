// The encoder spends most of its time on a surface here: each prediction reads 25 samples. With AVX2 it multiplies
// pairs of 16-bit samples and computes sixteen predictions at a time.
#include <algorithm>
#include <limits>

#include <spindrift/bitstream/encode/surface_predictor.h>

#include "processor.h"

#if SPINDRIFT_HAS_VECTORS
#include <immintrin.h>
#endif

namespace spindrift::codec {
namespace {

using W = SurfaceWeights;
constexpr std::int32_t kHalf = 1 << (kWeightBits - 1);

/// Wraps around at 32 bits, like the sums of products.
std::uint32_t times(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b);
}

/// Pointers to sample 0 of row z and its neighbour rows in the two previous frames, and the weights. A missing frame is
/// replaced by another plane with the weights 0.
struct Rows {
  const std::int16_t *b0, *bn, *bs, *bnn, *bss;
  const std::int16_t *e0, *en, *es;
  SurfaceWeights weights;
};
Rows rowsAround(const SurfacePlane& stand_in, const SurfaceHistory& history, const SurfaceWeights& weights,
                std::size_t z) {
  const auto at = static_cast<std::ptrdiff_t>(z);
  const SurfacePlane& b = history.before != nullptr ? *history.before : stand_in;
  const SurfacePlane& e = history.earlier != nullptr ? *history.earlier : stand_in;
  Rows rows{b.row(at), b.row(at - 1), b.row(at + 1), b.row(at - 2), b.row(at + 2),
            e.row(at), e.row(at - 1), e.row(at + 1), weights};
  if (history.before == nullptr) std::fill_n(rows.weights.of.begin() + W::kBefore, 4, 0);
  if (history.earlier == nullptr) std::fill_n(rows.weights.of.begin() + W::kEarlier, 3, 0);
  return rows;
}

void fromHistory(const Rows& rows, std::size_t begin, std::span<std::int32_t> out) {
  const auto [b0, bn, bs, bnn, bss, e0, en, es, weights] = rows;
  const auto& w = weights.of;
  for (std::size_t i = begin; i < out.size(); ++i) {
    const auto x = static_cast<std::ptrdiff_t>(i);
    const std::int32_t nearest = b0[x - 1] + b0[x + 1] + bn[x] + bs[x];
    const std::int32_t diagonal = bn[x - 1] + bn[x + 1] + bs[x - 1] + bs[x + 1];
    const std::int32_t far = b0[x - 2] + b0[x + 2] + bnn[x] + bss[x];
    const std::int32_t e_nearest = e0[x - 1] + e0[x + 1] + en[x] + es[x];
    const std::int32_t e_diagonal = en[x - 1] + en[x + 1] + es[x - 1] + es[x + 1];
    const std::uint32_t before = times(w[W::kBefore], b0[x]) + times(w[W::kBeforeNearest], nearest) +
                                 times(w[W::kBeforeDiagonal], diagonal) + times(w[W::kBeforeFar], far);
    const std::uint32_t earlier = times(w[W::kEarlier], e0[x]) + times(w[W::kEarlierNearest], e_nearest) +
                                  times(w[W::kEarlierDiagonal], e_diagonal);
    out[i] = static_cast<std::int32_t>(kHalf + before + earlier);
  }
}

#if SPINDRIFT_HAS_VECTORS

bool fits16Bits(const SurfaceWeights& weights) {
  return std::ranges::all_of(weights.of, [](std::int32_t w) {
    return w >= std::numeric_limits<std::int16_t>::min() && w <= std::numeric_limits<std::int16_t>::max();
  });
}

/// Sixteen sums of 32 bits: the low and the high four of each eight.
struct Sums {
  __m256i low, high;
};
/// Two weights, alternating.
SPINDRIFT_AVX2 __m256i pairOf(std::int32_t a, std::int32_t b) {
  return _mm256_set1_epi32(
      static_cast<std::int32_t>(static_cast<std::uint32_t>(a & 0xffff) | static_cast<std::uint32_t>(b) << 16));
}
/// Adds weight a times p[0..15] and weight b times q[0..15]. Like the sums, the sum of two products wraps around at 32
/// bits.
SPINDRIFT_AVX2 void add(Sums& sums, __m256i a, __m256i b, __m256i weights) {
  sums.low = _mm256_add_epi32(sums.low, _mm256_madd_epi16(_mm256_unpacklo_epi16(a, b), weights));
  sums.high = _mm256_add_epi32(sums.high, _mm256_madd_epi16(_mm256_unpackhi_epi16(a, b), weights));
}
SPINDRIFT_AVX2 __m256i load(const std::int16_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
SPINDRIFT_AVX2 void add(Sums& sums, const std::int16_t* p, const std::int16_t* q, __m256i weights) {
  add(sums, load(p), load(q), weights);
}
/// Returns the low 16 bits of sum >> kWeightBits, sign-extended.
SPINDRIFT_AVX2 __m256i shifted(__m256i sum) {
  return _mm256_srai_epi32(_mm256_slli_epi32(sum, 16 - kWeightBits), 16);
}

/// Computes the residuals from sample 1 on, at least 16. Not for row 0, where not all neighbours are known.
__attribute__((target("avx2"))) void residualsInSixteens(const std::int16_t* here, const std::int16_t* above,
                                                         const Rows& rows, std::span<std::int16_t> out) {
  const auto [b0, bn, bs, bnn, bss, e0, en, es, weights] = rows;
  const auto& w = weights.of;
  const __m256i own = pairOf(w[W::kBefore], w[W::kEarlier]);
  const __m256i nearest = pairOf(w[W::kBeforeNearest], w[W::kBeforeNearest]);
  const __m256i diagonal = pairOf(w[W::kBeforeDiagonal], w[W::kBeforeDiagonal]);
  const __m256i far = pairOf(w[W::kBeforeFar], w[W::kBeforeFar]);
  const __m256i e_nearest = pairOf(w[W::kEarlierNearest], w[W::kEarlierNearest]);
  const __m256i e_diagonal = pairOf(w[W::kEarlierDiagonal], w[W::kEarlierDiagonal]);
  const __m256i known = pairOf(w[W::kWest], w[W::kNorth]);
  const __m256i north_west = pairOf(w[W::kNorthWest], 0);
  // The last sixteen overlap the sixteen before them.
  const std::size_t last = out.size() - 16;
  for (std::size_t x = 1;; x = std::min(x + 16, last)) {
    Sums sums{_mm256_set1_epi32(kHalf), _mm256_set1_epi32(kHalf)};
    add(sums, b0 + x, e0 + x, own);
    add(sums, b0 + x - 1, b0 + x + 1, nearest);
    add(sums, bn + x, bs + x, nearest);
    add(sums, bn + x - 1, bn + x + 1, diagonal);
    add(sums, bs + x - 1, bs + x + 1, diagonal);
    add(sums, b0 + x - 2, b0 + x + 2, far);
    add(sums, bnn + x, bss + x, far);
    add(sums, e0 + x - 1, e0 + x + 1, e_nearest);
    add(sums, en + x, es + x, e_nearest);
    add(sums, en + x - 1, en + x + 1, e_diagonal);
    add(sums, es + x - 1, es + x + 1, e_diagonal);
    add(sums, here + x - 1, above + x, known);
    add(sums, above + x - 1, above + x - 1, north_west);
    const __m256i prediction = _mm256_packs_epi32(shifted(sums.low), shifted(sums.high));
    const __m256i samples = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(here + x));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.data() + x), _mm256_sub_epi16(samples, prediction));
    if (x == last) break;
  }
}

SPINDRIFT_AVX2 __m256i sumOf(const std::int16_t* a, const std::int16_t* b, const std::int16_t* c,
                             const std::int16_t* d) {
  return _mm256_add_epi16(_mm256_add_epi16(load(a), load(b)), _mm256_add_epi16(load(c), load(d)));
}
/// The same if sums of four samples fit into 16 bits: adds the neighbours before it multiplies.
__attribute__((target("avx2"))) void smallResidualsInSixteens(const std::int16_t* here, const std::int16_t* above,
                                                              const Rows& rows, std::span<std::int16_t> out) {
  const auto [b0, bn, bs, bnn, bss, e0, en, es, weights] = rows;
  const auto& w = weights.of;
  const __m256i before_nearest = pairOf(w[W::kBefore], w[W::kBeforeNearest]);
  const __m256i diagonal_far = pairOf(w[W::kBeforeDiagonal], w[W::kBeforeFar]);
  const __m256i earlier_nearest = pairOf(w[W::kEarlier], w[W::kEarlierNearest]);
  const __m256i diagonal_corner = pairOf(w[W::kEarlierDiagonal], w[W::kNorthWest]);
  const __m256i west_north = pairOf(w[W::kWest], w[W::kNorth]);
  // The last sixteen overlap the sixteen before them.
  const std::size_t last = out.size() - 16;
  for (std::size_t x = 1;; x = std::min(x + 16, last)) {
    Sums sums{_mm256_set1_epi32(kHalf), _mm256_set1_epi32(kHalf)};
    add(sums, load(b0 + x), sumOf(b0 + x - 1, b0 + x + 1, bn + x, bs + x), before_nearest);
    add(sums, sumOf(bn + x - 1, bn + x + 1, bs + x - 1, bs + x + 1), sumOf(b0 + x - 2, b0 + x + 2, bnn + x, bss + x),
        diagonal_far);
    add(sums, load(e0 + x), sumOf(e0 + x - 1, e0 + x + 1, en + x, es + x), earlier_nearest);
    add(sums, sumOf(en + x - 1, en + x + 1, es + x - 1, es + x + 1), load(above + x - 1), diagonal_corner);
    add(sums, load(here + x - 1), load(above + x), west_north);
    const __m256i prediction = _mm256_packs_epi32(shifted(sums.low), shifted(sums.high));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.data() + x), _mm256_sub_epi16(load(here + x), prediction));
    if (x == last) break;
  }
}

#endif

}  // namespace

std::int16_t predictionOf(std::int32_t from_history, const KnownSamples& known, const SurfaceWeights& weights) {
  const std::uint32_t sum = static_cast<std::uint32_t>(from_history) + times(weights.of[W::kWest], known.west) +
                            times(weights.of[W::kNorth], known.north) +
                            times(weights.of[W::kNorthWest], known.north_west);
  return static_cast<std::int16_t>(static_cast<std::int32_t>(sum) >> kWeightBits);
}

void residualsOfRow(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                    std::size_t z, std::span<std::int32_t> sums, std::span<std::int16_t> out) {
  const Rows rows = rowsAround(plane, history, weights, z);
  const auto at = static_cast<std::ptrdiff_t>(z);
  const std::int16_t* here = plane.row(at);
  const std::int16_t* above = plane.row(at - 1);
  std::size_t begin = 1;
#if SPINDRIFT_HAS_VECTORS
  if (z > 0 && out.size() > 16 && usesVectors() && fits16Bits(weights)) {
    const bool is_small = plane.isSmall() && (history.before == nullptr || history.before->isSmall()) &&
                          (history.earlier == nullptr || history.earlier->isSmall());
    (is_small ? smallResidualsInSixteens : residualsInSixteens)(here, above, rows, out);
    begin = out.size();
  }
#endif
  fromHistory(rows, 0, sums.first(1));
  fromHistory(rows, begin, sums);
  const auto residualAt = [&](std::size_t x, const KnownSamples& known) {
    return static_cast<std::int16_t>(here[x] - predictionOf(sums[x], known, weights));
  };
  const std::int32_t first = z > 0 ? above[0] : 0;
  out[0] = residualAt(0, {first, first, first});
  for (std::size_t x = begin; x < out.size(); ++x) {
    const std::int32_t west = here[x - 1];
    out[x] = residualAt(x, z > 0 ? KnownSamples{west, above[x], above[x - 1]} : KnownSamples{west, west, west});
  }
}

}  // namespace spindrift::codec
