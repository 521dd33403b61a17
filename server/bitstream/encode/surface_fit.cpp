#include <algorithm>
#include <cmath>

#include <spindrift/bitstream/encode/surface_predictor.h>

namespace spindrift::codec {
namespace {

using W = SurfaceWeights;
/// Weights stay within 16 bits, so that a prediction can use pairs of 16-bit numbers.
constexpr double kMaxWeight = 32000.0;

/// Solves A x = b for a symmetric A (upper half given). A small term on the diagonal makes A positive definite.
template <std::size_t N>
std::array<double, N> solve(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
  for (std::size_t i = 0; i < N; ++i) {
    a[i][i] = a[i][i] * (1 + 1e-9) + 1e-3;
    for (std::size_t j = 0; j < i; ++j) a[i][j] = a[j][i];
  }
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

/// Planes of fewer samples per side have too few positions for a guess.
constexpr std::size_t kGuessedResolution = 64;
constexpr std::size_t kCount = W::kTermCount;
constexpr std::size_t kWanted = kCount;
/// Samples per run, runs per row, and number of rows that the fit reads.
constexpr std::size_t kRun = 16;
constexpr std::size_t kRunsPerRow = 4;
constexpr std::size_t kRows = 64;

/// The terms of a run of samples and, last, the samples themselves; 0 beyond the plane.
using Run = std::array<std::array<float, kRun>, kCount + 1>;
/// Sums of the products of terms over the runs of a row, in four lanes each.
using RowSums = std::array<std::array<std::array<float, 4>, kCount + 1>, kCount>;

void putTermsAround(const SurfacePlane& plane, std::ptrdiff_t x, std::ptrdiff_t z, std::ptrdiff_t count,
                    std::size_t first, Run& out) {
  const std::int16_t *here = plane.row(z) + x, *north = plane.row(z - 1) + x, *south = plane.row(z + 1) + x;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[first][k] = here[i];
    out[first + 1][k] = static_cast<float>(here[i - 1] + here[i + 1] + north[i] + south[i]);
    out[first + 2][k] = static_cast<float>(north[i - 1] + north[i + 1] + south[i - 1] + south[i + 1]);
  }
}

/// Computes the terms of a run that starts at sample (x, z), x and z at least 1.
void putTerms(const SurfacePlane& plane, const SurfaceHistory& history, std::ptrdiff_t x, std::ptrdiff_t z, Run& out) {
  const std::ptrdiff_t count = std::min<std::ptrdiff_t>(kRun, static_cast<std::ptrdiff_t>(plane.count().x) - x);
  if (history.before != nullptr) {
    const SurfacePlane& b = *history.before;
    putTermsAround(b, x, z, count, W::kBefore, out);
    const std::int16_t *here = b.row(z) + x, *north = b.row(z - 2) + x, *south = b.row(z + 2) + x;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      out[W::kBeforeFar][static_cast<std::size_t>(i)] =
          static_cast<float>(here[i - 2] + here[i + 2] + north[i] + south[i]);
    }
  }
  if (history.earlier != nullptr) putTermsAround(*history.earlier, x, z, count, W::kEarlier, out);
  const std::int16_t *here = plane.row(z) + x, *above = plane.row(z - 1) + x;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out[W::kWest][k] = here[i - 1];
    out[W::kNorth][k] = above[i];
    out[W::kNorthWest][k] = above[i - 1];
    out[kWanted][k] = here[i];
  }
  for (std::array<float, kRun>& term : out) std::fill(term.begin() + count, term.end(), 0.0f);
}

/// Divides a run by the root mean square of what `guess` leaves of its samples.
void weigh(const SurfaceWeights& guess, std::ptrdiff_t count, Run& run) {
  /// Square of a residual that is as cheap as none [quanta^2].
  constexpr float kFree = 0.3f;
  std::array<float, kRun> rest = run[kWanted];
  for (std::size_t k = 0; k < kCount; ++k) {
    const float weight = static_cast<float>(guess.of[k]) / (1 << kWeightBits);
    for (std::size_t i = 0; i < kRun; ++i) rest[i] -= weight * run[k][i];
  }
  float squares = 0.0f;
  for (const float r : rest) squares += r * r;  // terms and samples beyond the plane are 0
  const float scale = 1.0f / std::sqrt(squares / static_cast<float>(count) + kFree);
  for (std::array<float, kRun>& term : run) {
    for (float& value : term) value *= scale;
  }
}

void addProducts(const Run& run, RowSums& sums) {
  for (std::size_t k = 0; k < kCount; ++k) {
    for (std::size_t l = k; l <= kWanted; ++l) {
      std::array<float, 4> sum = sums[k][l];
      for (std::size_t i = 0; i < kRun; i += 4) {
        for (std::size_t lane = 0; lane < 4; ++lane) sum[lane] += run[k][i + lane] * run[l][i + lane];
      }
      sums[k][l] = sum;
    }
  }
}

}  // namespace

SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights* guess) {
  const std::size_t nx = plane.count().x;
  const std::size_t nz = plane.count().z;
  if (plane.count().total() < kGuessedResolution * kGuessedResolution) guess = nullptr;
  const std::size_t row_stride = std::max<std::size_t>(nz / kRows, 1);
  const std::size_t run_stride = std::max(nx / kRunsPerRow, kRun);
  std::array<std::array<double, kCount>, kCount> products{};
  std::array<double, kCount> right{};
  Run run{};
  // A plane of one row or one column has no better position than its edge.
  const std::size_t first_x = nx > 1 ? 1 : 0;
  for (std::size_t z = nz > 1 ? 1 : 0, line = 0; z < nz; z += row_stride, ++line) {
    RowSums sums{};
    // Start at another column in each row, so that the samples do not all fall on one regular pattern.
    for (std::size_t x = first_x + line * 37 % (run_stride - kRun + 1); x < nx; x += run_stride) {
      putTerms(plane, history, static_cast<std::ptrdiff_t>(x), static_cast<std::ptrdiff_t>(z), run);
      if (guess != nullptr) weigh(*guess, static_cast<std::ptrdiff_t>(std::min(kRun, nx - x)), run);
      addProducts(run, sums);
    }
    const auto sumOf = [&sums](std::size_t k, std::size_t l) {
      const std::array<float, 4>& lanes = sums[k][l];
      return static_cast<double>(lanes[0]) + lanes[1] + lanes[2] + lanes[3];
    };
    for (std::size_t k = 0; k < kCount; ++k) {
      right[k] += sumOf(k, kWanted);
      for (std::size_t l = k; l < kCount; ++l) products[k][l] += sumOf(k, l);
    }
  }
  const std::array<double, kCount> fitted = solve(products, right);
  // Number of samples that each weight multiplies: a level surface stays level only if the weighted sum of the weights
  // survives rounding.
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

}  // namespace spindrift::codec
