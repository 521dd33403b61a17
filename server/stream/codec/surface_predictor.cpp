#include "surface_predictor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace spindrift::stream {
namespace {

using W = SurfaceWeights;
constexpr std::size_t kTile = 8;
/// Samples that a fit looks at: one in so many along both axes.
constexpr std::size_t kFitStride = 4;
constexpr std::int32_t kMaxWeight = 16 << kWeightBits;

/// Addition and multiplication that wrap around.
std::int32_t times(std::int32_t weight, std::int32_t sum) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(weight) * static_cast<std::uint32_t>(sum));
}
std::int32_t plus(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// What the frames before say about row z, rounding included, times 4096.
void predictFromHistory(const SurfaceHistory& history, const SurfaceWeights& weights, std::size_t z,
                        std::span<std::int32_t> out) {
  constexpr std::int32_t kHalf = 1 << (kWeightBits - 1);
  const auto& w = weights.of;
  const auto at = static_cast<std::ptrdiff_t>(z);
  const std::size_t n = out.size();
  if (history.before == nullptr) {
    std::ranges::fill(out, kHalf);
    return;
  }
  const SurfacePlane& b = *history.before;
  const std::int16_t *b0 = b.row(at), *bn = b.row(at - 1), *bs = b.row(at + 1), *bnn = b.row(at - 2),
                     *bss = b.row(at + 2);
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<std::ptrdiff_t>(i);
    const std::int32_t nearest = b0[x - 1] + b0[x + 1] + bn[x] + bs[x];
    const std::int32_t diagonal = bn[x - 1] + bn[x + 1] + bs[x - 1] + bs[x + 1];
    const std::int32_t far = b0[x - 2] + b0[x + 2] + bnn[x] + bss[x];
    out[i] = plus(plus(kHalf, times(w[W::kBefore], b0[x])),
                  plus(plus(times(w[W::kBeforeNearest], nearest), times(w[W::kBeforeDiagonal], diagonal)),
                       times(w[W::kBeforeFar], far)));
  }
  if (history.earlier == nullptr) return;
  const SurfacePlane& e = *history.earlier;
  const std::int16_t *e0 = e.row(at), *en = e.row(at - 1), *es = e.row(at + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<std::ptrdiff_t>(i);
    const std::int32_t nearest = e0[x - 1] + e0[x + 1] + en[x] + es[x];
    const std::int32_t diagonal = en[x - 1] + en[x + 1] + es[x - 1] + es[x + 1];
    out[i] = plus(out[i], plus(times(w[W::kEarlier], e0[x]),
                               plus(times(w[W::kEarlierNearest], nearest), times(w[W::kEarlierDiagonal], diagonal))));
  }
}

/// The neighbours of a sample that are known already; at the edges the nearest known one stands for a missing one.
struct Known {
  std::int32_t west, north, north_west;
};
Known knownAround(const SurfacePlane& plane, std::size_t x, std::size_t z) {
  const std::int16_t* here = plane.row(static_cast<std::ptrdiff_t>(z));
  if (z == 0) {
    const std::int32_t west = x > 0 ? here[x - 1] : 0;
    return {west, west, west};
  }
  const std::int16_t* above = plane.row(static_cast<std::ptrdiff_t>(z) - 1);
  if (x == 0) return {above[0], above[0], above[0]};
  return {here[x - 1], above[x], above[x - 1]};
}

std::int16_t predictionOf(std::int32_t from_history, const Known& known, const SurfaceWeights& weights) {
  const auto& w = weights.of;
  const std::int32_t sum = plus(plus(from_history, times(w[W::kWest], known.west)),
                                plus(times(w[W::kNorth], known.north), times(w[W::kNorthWest], known.north_west)));
  return static_cast<std::int16_t>(sum >> kWeightBits);
}

/// Solves A x = b, A symmetric and made positive definite by a little on its diagonal.
template <std::size_t N>
std::array<double, N> solve(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
  for (std::size_t i = 0; i < N; ++i) a[i][i] = a[i][i] * (1 + 1e-9) + 1e-3;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = i + 1; j < N; ++j) {
      const double factor = a[j][i] / a[i][i];
      for (std::size_t k = i; k < N; ++k) a[j][k] -= factor * a[i][k];
      b[j] -= factor * b[i];
    }
  }
  std::array<double, N> x{};
  for (std::size_t i = N; i-- > 0;) {
    double sum = b[i];
    for (std::size_t k = i + 1; k < N; ++k) sum -= a[i][k] * x[k];
    x[i] = sum / a[i][i];
  }
  return x;
}

}  // namespace

SurfacePlane::SurfacePlane(std::size_t resolution_count)
    : n_(resolution_count), samples_((n_ + 2 * kBorder) * (n_ + 2 * kBorder)) {}

void SurfacePlane::assign(std::span<const std::int16_t> samples) {
  assert(samples.size() == n_ * n_);
  for (std::size_t z = 0; z < n_; ++z) std::copy_n(samples.data() + z * n_, n_, row(static_cast<std::ptrdiff_t>(z)));
  fillBorder();
}

void SurfacePlane::fillBorder() {
  const auto last = static_cast<std::ptrdiff_t>(n_) - 1;
  for (std::ptrdiff_t z = 0; z <= last; ++z) {
    std::int16_t* r = row(z);
    r[-1] = r[-2] = r[0];
    r[last + 1] = r[last + 2] = r[last];
  }
  for (const std::ptrdiff_t z : {std::ptrdiff_t{-2}, std::ptrdiff_t{-1}})
    std::copy_n(row(0) - kBorder, stride(), row(z) - kBorder);
  for (const std::ptrdiff_t z : {last + 1, last + 2}) std::copy_n(row(last) - kBorder, stride(), row(z) - kBorder);
}

SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history) {
  constexpr std::size_t kCount = W::kTermCount;
  const std::size_t n = plane.resolution();
  std::array<std::array<double, kCount>, kCount> products{};
  std::array<double, kCount> right{};
  for (std::size_t z = 1; z < n; z += kFitStride) {
    std::array<std::array<float, kCount>, kCount> row_products{};
    std::array<float, kCount> row_right{};
    const auto at = static_cast<std::ptrdiff_t>(z);
    // Other columns in each row, lest a pattern of the grid's spacing be all that is seen.
    for (std::size_t i = 1 + z / kFitStride % kFitStride; i < n; i += kFitStride) {
      const auto x = static_cast<std::ptrdiff_t>(i);
      std::array<float, kCount> term{};
      const auto around = [&](const SurfacePlane& p, std::size_t first) {
        const std::int16_t *r0 = p.row(at), *rn = p.row(at - 1), *rs = p.row(at + 1);
        term[first] = r0[x];
        term[first + 1] = static_cast<float>(r0[x - 1] + r0[x + 1] + rn[x] + rs[x]);
        term[first + 2] = static_cast<float>(rn[x - 1] + rn[x + 1] + rs[x - 1] + rs[x + 1]);
      };
      if (history.before != nullptr) {
        const SurfacePlane& b = *history.before;
        around(b, W::kBefore);
        term[W::kBeforeFar] =
            static_cast<float>(b.row(at)[x - 2] + b.row(at)[x + 2] + b.row(at - 2)[x] + b.row(at + 2)[x]);
      }
      if (history.earlier != nullptr) around(*history.earlier, W::kEarlier);
      const Known known = knownAround(plane, i, z);
      term[W::kWest] = static_cast<float>(known.west);
      term[W::kNorth] = static_cast<float>(known.north);
      term[W::kNorthWest] = static_cast<float>(known.north_west);
      const float wanted = plane.row(at)[x];
      for (std::size_t k = 0; k < kCount; ++k) {
        row_right[k] += term[k] * wanted;
        for (std::size_t l = 0; l < kCount; ++l) row_products[k][l] += term[k] * term[l];
      }
    }
    for (std::size_t k = 0; k < kCount; ++k) {
      right[k] += row_right[k];
      for (std::size_t l = 0; l < kCount; ++l) products[k][l] += row_products[k][l];
    }
  }
  const std::array<double, kCount> fitted = solve(products, right);
  // How many samples each weight counts for: a level surface stays level only if their sum survives the rounding.
  constexpr std::array<int, kCount> kSamples = {1, 4, 4, 4, 1, 4, 4, 1, 1, 1};
  SurfaceWeights weights;
  double sum = 0.0;
  std::int64_t rounded_sum = 0;
  for (std::size_t k = 0; k < kCount; ++k) {
    const double scaled = std::isfinite(fitted[k]) ? fitted[k] * (1 << kWeightBits) : 0.0;
    weights.of[k] = static_cast<std::int32_t>(
        std::lround(std::clamp(scaled, -static_cast<double>(kMaxWeight), static_cast<double>(kMaxWeight))));
    sum += kSamples[k] * scaled;
    rounded_sum += std::int64_t{kSamples[k]} * weights.of[k];
  }
  const double missing = std::clamp(sum - static_cast<double>(rounded_sum), -100.0, 100.0);
  weights.of[history.before != nullptr ? W::kBefore : W::kWest] += static_cast<std::int32_t>(std::lround(missing));
  return weights;
}

void encodePlane(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                 ResidualEncoder& out) {
  const std::size_t n = plane.resolution();
  const std::size_t tiles = (n + kTile - 1) / kTile;
  std::vector<std::uint32_t> classes(tiles, 0);
  std::vector<std::int16_t> residuals(kTile * n);
  std::vector<std::int32_t> from_history(n);
  for (std::size_t top = 0; top < n; top += kTile) {
    const std::size_t rows = std::min(kTile, n - top);
    for (std::size_t j = 0; j < rows; ++j) {
      const std::size_t z = top + j;
      predictFromHistory(history, weights, z, from_history);
      const std::int16_t* here = plane.row(static_cast<std::ptrdiff_t>(z));
      std::int16_t* r = residuals.data() + j * n;
      r[0] = static_cast<std::int16_t>(here[0] - predictionOf(from_history[0], knownAround(plane, 0, z), weights));
      if (z == 0) {
        for (std::size_t x = 1; x < n; ++x)
          r[x] = static_cast<std::int16_t>(here[x] - predictionOf(from_history[x], knownAround(plane, x, z), weights));
        continue;
      }
      const std::int16_t* above = plane.row(static_cast<std::ptrdiff_t>(z) - 1);
      for (std::size_t x = 1; x < n; ++x) {
        const Known known = {here[x - 1], above[x], above[x - 1]};
        r[x] = static_cast<std::int16_t>(here[x] - predictionOf(from_history[x], known, weights));
      }
    }
    std::uint32_t left = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
      const std::size_t columns = std::min(kTile, n - tile * kTile);
      std::array<std::int16_t, kGroupMaxCount> group;
      for (std::size_t j = 0; j < rows; ++j)
        std::copy_n(residuals.data() + j * n + tile * kTile, columns, group.data() + j * columns);
      left = classes[tile] = out.putGroup(std::span(group).first(rows * columns), left, classes[tile]);
    }
  }
}

void decodePlane(ResidualDecoder& in, const SurfaceHistory& history, const SurfaceWeights& weights,
                 SurfacePlane& plane) {
  const std::size_t n = plane.resolution();
  const std::size_t tiles = (n + kTile - 1) / kTile;
  std::vector<std::uint32_t> classes(tiles, 0);
  std::vector<std::int16_t> residuals(kTile * n);
  std::vector<std::int32_t> from_history(n);
  for (std::size_t top = 0; top < n; top += kTile) {
    const std::size_t rows = std::min(kTile, n - top);
    std::uint32_t left = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
      const std::size_t columns = std::min(kTile, n - tile * kTile);
      std::array<std::int16_t, kGroupMaxCount> group;
      left = classes[tile] = in.getGroup(std::span(group).first(rows * columns), left, classes[tile]);
      for (std::size_t j = 0; j < rows; ++j)
        std::copy_n(group.data() + j * columns, columns, residuals.data() + j * n + tile * kTile);
    }
    for (std::size_t j = 0; j < rows; ++j) {
      const std::size_t z = top + j;
      predictFromHistory(history, weights, z, from_history);
      std::int16_t* here = plane.row(static_cast<std::ptrdiff_t>(z));
      const std::int16_t* r = residuals.data() + j * n;
      for (std::size_t x = 0; x < n; ++x) {
        const std::int16_t prediction = predictionOf(from_history[x], knownAround(plane, x, z), weights);
        here[x] = static_cast<std::int16_t>(prediction + r[x]);
      }
    }
  }
  plane.fillBorder();
}

}  // namespace spindrift::stream
