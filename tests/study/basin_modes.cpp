#include "basin_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace spindrift::study {
namespace {

using Vector = std::vector<double>;

constexpr double kLargest = 8.0;  ///< bound of the eigenvalues, in cells
constexpr double kResidual = 1e-6;
constexpr int kMaxRounds = 60;

/// The negative Laplacian of the wet cells, in cells.
class Laplacian {
 public:
  explicit Laplacian(const sim::Basin& basin) {
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(basin.depth_m.size()))));
    std::vector<std::size_t> number(n * n);
    for (std::size_t i = 0; i < n * n; ++i) {
      if (basin.depth_m[i] <= 0) continue;
      number[i] = cells_.size();
      cells_.push_back(i);
    }
    for (const std::size_t i : cells_) {
      const std::size_t right = (i % n + 1) % n + i / n * n;
      const std::size_t next = (i + n) % (n * n);
      if (basin.conductance_m[i][0] > 0) faces_.push_back({number[i], number[right]});
      if (basin.conductance_m[i][1] > 0) faces_.push_back({number[i], number[next]});
    }
  }
  [[nodiscard]] const std::vector<std::size_t>& cells() const { return cells_; }

  void apply(const Vector& x, Vector& out) const {
    std::ranges::fill(out, 0.0);
    for (const auto& [a, b] : faces_) {
      const double step = x[a] - x[b];
      out[a] += step;
      out[b] -= step;
    }
  }

 private:
  std::vector<std::size_t> cells_;  ///< index of each wet cell
  std::vector<std::array<std::size_t, 2>> faces_;
};

double dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void addTo(Vector& a, double factor, const Vector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

/// Gram-Schmidt, twice; also against the level surface.
void orthonormalize(std::vector<Vector>& block) {
  for (std::size_t j = 0; j < block.size(); ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      const double mean = std::accumulate(block[j].begin(), block[j].end(), 0.0) / static_cast<double>(block[j].size());
      for (double& v : block[j]) v -= mean;
      for (std::size_t k = 0; k < j; ++k) addTo(block[j], -dot(block[j], block[k]), block[k]);
    }
    const double scale = 1 / std::sqrt(dot(block[j], block[j]));
    for (double& v : block[j]) v *= scale;
  }
}

/// Damps what belongs to eigenvalues from `cut` to kLargest, against the ones below.
Vector filtered(const Laplacian& laplacian, const Vector& x, double cut, int degree) {
  const double middle = 0.5 * (kLargest + cut);
  const double half = 0.5 * (kLargest - cut);
  Vector before = x;
  Vector now(x.size()), next(x.size());
  laplacian.apply(x, now);
  for (std::size_t i = 0; i < x.size(); ++i) now[i] = (now[i] - middle * x[i]) / half;
  for (int k = 2; k <= degree; ++k) {
    laplacian.apply(now, next);
    for (std::size_t i = 0; i < x.size(); ++i) next[i] = 2 * (next[i] - middle * now[i]) / half - before[i];
    std::swap(before, now);
    std::swap(now, next);
  }
  return now;
}

/// Eigenvalues and eigenvectors (columns) of a small symmetric matrix, by Jacobi's rotations.
std::pair<Vector, std::vector<Vector>> eigenOf(std::vector<Vector> a) {
  const std::size_t n = a.size();
  std::vector<Vector> v(n, Vector(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) v[i][i] = 1.0;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0.0;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        off += a[p][q] * a[p][q];
        if (std::abs(a[p][q]) < 1e-300) continue;
        const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
        const double t = std::copysign(1 / (std::abs(theta) + std::hypot(theta, 1.0)), theta);
        const double c = 1 / std::hypot(t, 1.0);
        const double s = t * c;
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
          const double vp = v[k][p], vq = v[k][q];
          v[k][p] = c * vp - s * vq;
          v[k][q] = s * vp + c * vq;
        }
      }
    }
    if (off < 1e-28) break;
  }
  Vector values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = a[i][i];
  return {std::move(values), std::move(v)};
}

}  // namespace

std::vector<BasinMode> lowestModes(const sim::WaveLayout& layout, const sim::Basin& basin, std::size_t count) {
  const Laplacian laplacian(basin);
  const std::size_t size = laplacian.cells().size();
  const std::size_t width = std::min(count + 6 + count / 8, size - 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Vector> block(width, Vector(size));
  for (Vector& x : block) std::ranges::generate(x, [&] { return any(random); });
  orthonormalize(block);
  Vector values(width);
  // By Weyl's law, about A k^2/(4 pi) modes lie below k^2.
  double cut = 4 * 3.15 * static_cast<double>(width) / static_cast<double>(size);
  Vector image(size);
  for (int round = 0; round < kMaxRounds; ++round) {
    const int degree = std::clamp(static_cast<int>(3 * std::sqrt(kLargest / cut)), 10, 150);
    for (Vector& x : block) x = filtered(laplacian, x, std::min(cut, 0.9 * kLargest), degree);
    orthonormalize(block);
    std::vector<Vector> small(width, Vector(width));
    for (std::size_t j = 0; j < width; ++j) {
      laplacian.apply(block[j], image);
      for (std::size_t k = 0; k < width; ++k) small[k][j] = dot(block[k], image);
    }
    const auto [ritz, vectors] = eigenOf(std::move(small));
    std::vector<std::size_t> order(width);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&, &found = ritz](std::size_t j) { return found[j]; });
    std::vector<Vector> turned(width, Vector(size, 0.0));
    for (std::size_t j = 0; j < width; ++j) {
      values[j] = ritz[order[j]];
      for (std::size_t k = 0; k < width; ++k) addTo(turned[j], vectors[k][order[j]], block[k]);
    }
    block = std::move(turned);
    cut = values.back();
    double worst = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      laplacian.apply(block[j], image);
      addTo(image, -values[j], block[j]);
      worst = std::max(worst, std::sqrt(dot(image, image)) / values[j]);
    }
    if (worst < kResidual) break;
  }
  std::vector<BasinMode> out;
  for (std::size_t j = 0; j < count; ++j) {
    BasinMode mode{std::sqrt(values[j]) / layout.cell_m, Vector(basin.depth_m.size(), 0.0)};
    for (std::size_t i = 0; i < size; ++i)
      mode.shape[laplacian.cells()[i]] = block[j][i] * std::sqrt(static_cast<double>(size));
    out.push_back(std::move(mode));
  }
  return out;
}

}  // namespace spindrift::study
