// A sample is predicted from its neighbours at x - 1, at z - 1 and at both, so one row alone is a serial chain.
// Therefore eight rows are predicted together, each one sample behind the row above it: the eight samples of such a
// diagonal depend only on the two diagonals before.
#include "band_prediction.h"

#include <algorithm>
#include <limits>

#include "format/short_vectors.h"

namespace spindrift::codec {
namespace {

using W = SurfaceWeights;
constexpr std::uint32_t kHalf = 1u << (kWeightBits - 1);

bool fits16Bits(std::int32_t value) {
  return value >= std::numeric_limits<std::int16_t>::min() && value <= std::numeric_limits<std::int16_t>::max();
}

Words splat(std::int32_t value) {
  const auto v = static_cast<std::uint32_t>(value);
  return Words{v, v, v, v};
}

/// Two weights for products of sample pairs, 16 bits each.
struct NarrowPair {
  Shorts weights;
  NarrowPair(std::int32_t a, std::int32_t b)
      : weights(Shorts(splat(static_cast<std::int32_t>((static_cast<std::uint32_t>(a) & 0xffffu) |
                                                       static_cast<std::uint32_t>(b) << 16)))) {}
  Words operator()(Shorts pairs) const { return sumsOfProducts(pairs, weights); }
};
/// Two weights of up to 32 bits each.
struct WidePair {
  Words a, b;
  WidePair(std::int32_t of_a, std::int32_t of_b) : a(splat(of_a)), b(splat(of_b)) {}
  Words operator()(Shorts pairs) const {
    return Words(SignedWords(Words(pairs) << 16) >> 16) * a + Words(SignedWords(pairs) >> 16) * b;
  }
};

template <typename Pair>
void sumFrames(const HistoryRows& history, const SurfaceWeights& weights, const ResidualGroup* tiles, std::size_t j,
               std::size_t tiles_count, std::uint32_t* sums) {
  const auto& w = weights.of;
  const std::int16_t *b0 = history.before, *bn = b0 - history.stride, *bs = b0 + history.stride;
  const std::int16_t *bnn = bn - history.stride, *bss = bs + history.stride;
  const std::int16_t *e0 = history.earlier, *en = e0 - history.stride, *es = e0 + history.stride;
  const Pair own(w[W::kBefore], w[W::kEarlier]);
  const Pair nearest(w[W::kBeforeNearest], w[W::kBeforeNearest]), far(w[W::kBeforeFar], w[W::kBeforeFar]);
  const Pair diagonal(w[W::kBeforeDiagonal], w[W::kBeforeDiagonal]);
  const Pair e_nearest(w[W::kEarlierNearest], w[W::kEarlierNearest]);
  const Pair e_diagonal(w[W::kEarlierDiagonal], w[W::kEarlierDiagonal]);
  for (std::size_t x = 0; x < kTile * tiles_count; x += kTile, ++tiles) {
    const Shorts r = loadVector<Shorts>(tiles->of.data() + j * kTile);
    const Shorts zeros{};
    // Residual times 2^kWeightBits with its sign: it starts in the upper half of each 32 bits.
    Words low = Words(SignedWords(interleaveLow(zeros, r)) >> (16 - kWeightBits)) + kHalf;
    Words high = Words(SignedWords(interleaveHigh(zeros, r)) >> (16 - kWeightBits)) + kHalf;
    const auto add = [&](const std::int16_t* p, const std::int16_t* q, const Pair& pair) {
      const Shorts a = loadVector<Shorts>(p), b = loadVector<Shorts>(q);
      low += pair(interleaveLow(a, b));
      high += pair(interleaveHigh(a, b));
    };
    add(b0 + x, e0 + x, own);
    add(b0 + x - 1, b0 + x + 1, nearest);
    add(bn + x, bs + x, nearest);
    add(bn + x - 1, bn + x + 1, diagonal);
    add(bs + x - 1, bs + x + 1, diagonal);
    add(b0 + x - 2, b0 + x + 2, far);
    add(bnn + x, bss + x, far);
    add(e0 + x - 1, e0 + x + 1, e_nearest);
    add(en + x, es + x, e_nearest);
    add(en + x - 1, en + x + 1, e_diagonal);
    add(es + x - 1, es + x + 1, e_diagonal);
    storeVector(sums + x, low);
    storeVector(sums + x + 4, high);
  }
}

/// The weights of the known neighbours for four rows. In row 0 the neighbour at x - 1 replaces all three.
struct NarrowKnown {
  Shorts west_and_north, north_west;
  NarrowKnown(const SurfaceWeights& weights, bool begins_with_row_0) {
    const auto& w = weights.of;
    const auto west = static_cast<std::int16_t>(w[W::kWest]), north = static_cast<std::int16_t>(w[W::kNorth]);
    west_and_north = Shorts{west, north, west, north, west, north, west, north};
    const auto diagonal = static_cast<std::int16_t>(w[W::kNorthWest]);
    north_west = Shorts{diagonal, 0, diagonal, 0, diagonal, 0, diagonal, 0};
    if (!begins_with_row_0) return;
    west_and_north[0] = static_cast<std::int16_t>(w[W::kWest] + w[W::kNorth] + w[W::kNorthWest]);
    west_and_north[1] = 0;
    north_west[0] = 0;
  }
  /// The neighbour that is known last is added last.
  Words operator()(Words sums, Words west, Words north, Words diagonal) const {
    return sums + sumsOfProducts(Shorts(diagonal), north_west) +
           sumsOfProducts(Shorts((west & 0xffffu) | north << 16), west_and_north);
  }
};
struct WideKnown {
  Words west_weights, north_weights, diagonal_weights;
  WideKnown(const SurfaceWeights& weights, bool begins_with_row_0)
      : west_weights(splat(weights.of[W::kWest])),
        north_weights(splat(weights.of[W::kNorth])),
        diagonal_weights(splat(weights.of[W::kNorthWest])) {
    if (!begins_with_row_0) return;
    west_weights[0] += north_weights[0] + diagonal_weights[0];
    north_weights[0] = diagonal_weights[0] = 0;
  }
  Words operator()(Words sums, Words west, Words north, Words diagonal) const {
    return sums + diagonal * diagonal_weights + north * north_weights + west * west_weights;
  }
};

/// Transposes 4 x 4 words: rows become columns.
void transpose(Words (&v)[4]) {
  const Words a = interleaveLow(v[0], v[2]), b = interleaveHigh(v[0], v[2]);
  const Words c = interleaveLow(v[1], v[3]), d = interleaveHigh(v[1], v[3]);
  v[0] = interleaveLow(a, c);
  v[1] = interleaveHigh(a, c);
  v[2] = interleaveLow(b, d);
  v[3] = interleaveHigh(b, d);
}
void transpose(Shorts (&v)[8]) {
  for (int pass = 0; pass < 3; ++pass) {
    Shorts w[8];
    for (int k = 0; k < 4; ++k) {
      w[2 * k] = interleaveLow(v[k], v[k + 4]);
      w[2 * k + 1] = interleaveHigh(v[k], v[k + 4]);
    }
    std::copy_n(w, 8, v);
  }
}

/// Samples of a diagonal and the samples above them, sign-extended; `upper` holds rows 0 to 3, `lower` rows 4 to 7.
struct Diagonal {
  Words upper{}, lower{};
  Words above_upper{}, above_lower{};
};

/// Mask with all bits of lane k of four.
constexpr Words onlyLane(int k) {
  return Words{k == 0 ? ~0u : 0u, k == 1 ? ~0u : 0u, k == 2 ? ~0u : 0u, k == 3 ? ~0u : 0u};
}
Words chosen(Words mask, Words where_set, Words elsewhere) {
  return (where_set & mask) | (elsewhere & ~mask);
}
Words sampleOf(Words sum) {
  return Words(SignedWords(sum << (16 - kWeightBits)) >> 16);
}

template <typename Known>
class BandPredictor {
 public:
  BandPredictor(const std::uint32_t* sums, std::size_t sums_stride, const SurfaceWeights& weights, bool is_first,
                std::int16_t* samples, std::size_t stride)
      : sums_(sums),
        sums_stride_(sums_stride),
        samples_(samples),
        stride_(stride),
        upper_(weights, is_first),
        lower_(weights, false) {}

  void predict(std::size_t n) {
    takeEight<true>(0);
    for (std::size_t begin = 8; begin < n + 7; begin += 8) takeEight<false>(begin);
  }

 private:
  /// Predicts eight diagonals; the sample of row j of diagonal s is at x = s - j. The first eight contain the starts of
  /// the rows: there the neighbour above replaces all three.
  template <bool kBeginsRows>
  void takeEight(std::size_t begin) {
    Shorts out[8];
    const std::int16_t* above = samples_ - stride_ + begin;
    for (int half = 0; half < 2; ++half) {
      Words upper[4], lower[4];
      for (std::size_t j = 0; j < 4; ++j) {
        const std::uint32_t* from = sums_ + j * sums_stride_ + begin + 4 * static_cast<std::size_t>(half) - j;
        upper[j] = loadVector<Words>(from);
        lower[j] = loadVector<Words>(from + 4 * sums_stride_ - 4);
      }
      transpose(upper);
      transpose(lower);
      for (int k = 0; k < 4; ++k) {
        const Diagonal& last = last_;
        const auto first_above = static_cast<std::uint32_t>(std::int32_t{above[4 * half + k]});
        Diagonal now;
        now.above_upper =
            __builtin_shufflevector(Words{first_above, first_above, first_above, first_above}, last.upper, 0, 4, 5, 6);
        now.above_lower = __builtin_shufflevector(last.upper, last.lower, 3, 4, 5, 6);
        Words west_upper = last.upper, west_lower = last.lower;
        Words diagonal_upper = last.above_upper, diagonal_lower = last.above_lower;
        if constexpr (kBeginsRows) {
          if (half == 0) {
            west_upper = chosen(onlyLane(k), now.above_upper, west_upper);
            diagonal_upper = chosen(onlyLane(k), now.above_upper, diagonal_upper);
          } else {
            west_lower = chosen(onlyLane(k), now.above_lower, west_lower);
            diagonal_lower = chosen(onlyLane(k), now.above_lower, diagonal_lower);
          }
        }
        now.upper = sampleOf(upper_(upper[k], west_upper, now.above_upper, diagonal_upper));
        now.lower = sampleOf(lower_(lower[k], west_lower, now.above_lower, diagonal_lower));
        out[4 * half + k] = narrowed(SignedWords(now.upper), SignedWords(now.lower));
        last_ = now;
      }
    }
    transpose(out);
    for (std::size_t j = 0; j < kTile; ++j) storeVector(samples_ + j * stride_ + begin - j, out[j]);
  }

  const std::uint32_t* sums_;
  std::size_t sums_stride_;
  std::int16_t* samples_;
  std::size_t stride_;
  Known upper_, lower_;
  Diagonal last_;
};

}  // namespace

void sumHistory(const HistoryRows& history, const SurfaceWeights& weights, const ResidualGroup* tiles, std::size_t j,
                std::size_t tiles_count, std::uint32_t* sums) {
  if (std::all_of(weights.of.begin(), weights.of.end(), fits16Bits))
    sumFrames<NarrowPair>(history, weights, tiles, j, tiles_count, sums);
  else
    sumFrames<WidePair>(history, weights, tiles, j, tiles_count, sums);
}

void sumResiduals(const ResidualGroup* tiles, std::size_t j, std::size_t tiles_count, std::uint32_t* sums) {
  for (std::size_t x = 0; x < kTile * tiles_count; ++x) {
    const std::int32_t r = tiles[x / kTile].of[j * kTile + x % kTile];
    sums[x] = (static_cast<std::uint32_t>(r) << kWeightBits) + kHalf;
  }
}

void predictBand(const std::uint32_t* sums, std::size_t sums_stride, const SurfaceWeights& weights, bool is_first,
                 std::int16_t* samples, std::size_t stride, std::size_t n) {
  const auto& w = weights.of;
  const std::int64_t all = std::int64_t{w[W::kWest]} + w[W::kNorth] + w[W::kNorthWest];
  const bool is_narrow = fits16Bits(w[W::kWest]) && fits16Bits(w[W::kNorth]) && fits16Bits(w[W::kNorthWest]) &&
                         all == static_cast<std::int16_t>(all);
  if (is_narrow)
    BandPredictor<NarrowKnown>(sums, sums_stride, weights, is_first, samples, stride).predict(n);
  else
    BandPredictor<WideKnown>(sums, sums_stride, weights, is_first, samples, stride).predict(n);
}

}  // namespace spindrift::codec
