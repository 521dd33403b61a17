#include "surface_fit.h"

#include <algorithm>
#include <cmath>

namespace spindrift::stream {
namespace {

using W = SurfaceWeights;
/// Below what 16 bits hold, so that a prediction can work on pairs of 16-bit numbers.
constexpr double kMaxWeight = 32000.0;

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

constexpr std::size_t kCount = W::kTermCount;
/// The terms of a sample, the sample itself, and a zero: three vectors of four.
constexpr std::size_t kWanted = kCount, kPadded = 12;
using Terms = std::array<float, kPadded>;

void putTermsAround(const SurfacePlane& plane, std::ptrdiff_t x, std::ptrdiff_t z, float* out) {
  const std::int16_t *here = plane.row(z), *north = plane.row(z - 1), *south = plane.row(z + 1);
  out[0] = here[x];
  out[1] = static_cast<float>(here[x - 1] + here[x + 1] + north[x] + south[x]);
  out[2] = static_cast<float>(north[x - 1] + north[x + 1] + south[x - 1] + south[x + 1]);
}

/// x, z >= 1.
Terms termsOf(const SurfacePlane& plane, const SurfaceHistory& history, std::ptrdiff_t x, std::ptrdiff_t z) {
  Terms term{};
  if (history.before != nullptr) {
    const SurfacePlane& b = *history.before;
    putTermsAround(b, x, z, term.data() + W::kBefore);
    term[W::kBeforeFar] = static_cast<float>(b.row(z)[x - 2] + b.row(z)[x + 2] + b.row(z - 2)[x] + b.row(z + 2)[x]);
  }
  if (history.earlier != nullptr) putTermsAround(*history.earlier, x, z, term.data() + W::kEarlier);
  const std::int16_t *here = plane.row(z), *above = plane.row(z - 1);
  term[W::kWest] = here[x - 1];
  term[W::kNorth] = above[x];
  term[W::kNorthWest] = above[x - 1];
  term[kWanted] = here[x];
  return term;
}

}  // namespace

SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history, std::size_t samples_count) {
  const std::size_t n = plane.resolution();
  const auto stride = static_cast<std::size_t>(
      std::max(std::sqrt(static_cast<double>(n * n) / static_cast<double>(samples_count)), 1.0));
  std::array<std::array<double, kCount>, kCount> products{};
  std::array<double, kCount> right{};
  for (std::size_t z = 1, line = 0; z < n; z += stride, ++line) {
    std::array<Terms, kCount> row_products{};
    // Other columns in each row, lest a pattern of the grid's spacing be all that is seen.
    for (std::size_t x = 1 + line * 7 % stride; x < n; x += stride) {
      const Terms term = termsOf(plane, history, static_cast<std::ptrdiff_t>(x), static_cast<std::ptrdiff_t>(z));
      for (std::size_t k = 0; k < kCount; ++k) {
        for (std::size_t l = 0; l < kPadded; ++l) row_products[k][l] += term[k] * term[l];
      }
    }
    for (std::size_t k = 0; k < kCount; ++k) {
      right[k] += row_products[k][kWanted];
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
    weights.of[k] = static_cast<std::int32_t>(std::lround(std::clamp(scaled, -kMaxWeight, kMaxWeight)));
    sum += kSamples[k] * scaled;
    rounded_sum += std::int64_t{kSamples[k]} * weights.of[k];
  }
  const double missing = std::clamp(sum - static_cast<double>(rounded_sum), -100.0, 100.0);
  weights.of[history.before != nullptr ? W::kBefore : W::kWest] += static_cast<std::int32_t>(std::lround(missing));
  return weights;
}

}  // namespace spindrift::stream
