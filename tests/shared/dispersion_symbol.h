// F of the dispersion over a flat bed without sides, as a factor of each plane wave: a local Fourier analysis of the
// V-cycle (Trottenberg, Oosterlee & Schueller 2001, Multigrid, chapter 4). The cycle is not the same at every cell; the
// factor is that of the wave in the answer to the wave, without the other waves in it.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

class DispersionSymbol {
 public:
  /// `grid_count`: of the V-cycle.
  DispersionSymbol(double depth_cells, const Poles& poles, std::size_t grid_count)
      : depth_cells_(depth_cells), poles_(poles), grid_count_(grid_count) {}

  /// F/d of a wave [radians per cell].
  [[nodiscard]] double share(double kx, double kz) const {
    double sum = shareAtOnce(depth_cells_);
    for (std::size_t j = 0; j < kPoleCount; ++j) sum += poles_.c[j] * poleShare(j, kx, kz);
    return sum;
  }

  /// Relative difference between the frequencies of the two standing waves of 2^(k + 1) cells along an axis, with
  /// crests on the edges of the blocks of grid k and between them: the wave and its reflection are one wave on that
  /// grid.
  [[nodiscard]] double split(std::size_t k) const {
    const double kx = 2 * std::numbers::pi / std::pow(2.0, static_cast<double>(k + 1));
    double sum = 0.0;
    for (std::size_t j = 0; j < kPoleCount; ++j) {
      double passed = poles_.c[j];
      for (std::size_t i = 0; i < k; ++i) {
        const double k_of_grid = kx * std::pow(2.0, static_cast<double>(i));
        const Grid grid = gridOf(j, i);
        passed *= std::pow(0.5 * (1 + std::cos(k_of_grid)) * grid.rest(grid.along(laplacian(k_of_grid, 0.0))), 2);
      }
      const Grid grid = gridOf(j, k);
      sum += passed * grid.solved(grid.along(4.0));
    }
    return sum / share(kx, 0.0);
  }

  /// Eigenvalue of the 5-point Laplacian, in cells.
  [[nodiscard]] static double laplacian(double kx, double kz) {
    return 4 * (std::pow(std::sin(0.5 * kx), 2) + std::pow(std::sin(0.5 * kz), 2));
  }

 private:
  using Complex = std::complex<double>;
  /// Hermitian, on the x and the z faces: [xx, xz; conj(xz), zz].
  struct Matrix {
    double xx, zz;
    Complex xz;
  };

  /// K of a grid, with d = 1, and its sweeps.
  struct Grid {
    double stiff, spread;
    bool is_coarsest;

    /// Eigenvalue of a wave along an axis.
    [[nodiscard]] double along(double laplacian) const { return 1 + (stiff - spread) * laplacian; }
    /// What sweeps leave of an error.
    [[nodiscard]] double rest(double eigenvalue) const {
      return std::pow(1 - kSweepWeight / (1 + 2 * stiff) * eigenvalue, is_coarsest ? kCoarsestSweepCount : kSweepCount);
    }
    /// What all sweeps of a cycle find, without coarser grids.
    [[nodiscard]] double solved(double eigenvalue) const {
      return (1 - (is_coarsest ? rest(eigenvalue) : std::pow(rest(eigenvalue), 2))) / eigenvalue;
    }
  };

  [[nodiscard]] Grid gridOf(std::size_t j, std::size_t k) const {
    return {poles_.bOf(k)[j] * std::pow(depth_cells_, 2) * std::pow(0.25, static_cast<double>(k)), spreadOf(k)[j],
            k + 1 == grid_count_};
  }

  /// (1/d - grad b d div)^-1/d of a longitudinal wave, by one cycle.
  [[nodiscard]] double poleShare(std::size_t j, double kx, double kz) const {
    const Complex gx = std::polar(1.0, kx) - 1.0;
    const Complex gz = std::polar(1.0, kz) - 1.0;
    const Matrix inverse = cycle(j, 0, kx, kz);
    return (inverse.xx * std::norm(gx) + inverse.zz * std::norm(gz) + 2 * (std::conj(gx) * inverse.xz * gz).real()) /
           (std::norm(gx) + std::norm(gz));
  }

  /// The cycle from grid k on, with d = 1.
  [[nodiscard]] Matrix cycle(std::size_t j, std::size_t k, double kx, double kz) const {
    const Grid grid = gridOf(j, k);
    const Complex dx = 1.0 - std::polar(1.0, -kx);
    const Complex dz = 1.0 - std::polar(1.0, -kz);
    const Matrix m{grid.along(std::norm(dx)), grid.along(std::norm(dz)), grid.stiff * std::conj(dx) * dz};
    const double middle = 0.5 * (m.xx + m.zz);
    const double apart = std::hypot(0.5 * (m.xx - m.zz), std::abs(m.xz));
    // A function of a matrix with two eigenvalues is linear in it.
    const auto applied = [&](const auto& function) -> Matrix {
      const double low = function(middle - apart);
      if (apart < 1e-12 * middle) return {low, low, 0.0};
      const double slope = (function(middle + apart) - low) / (2 * apart);
      const double at_zero = low - slope * (middle - apart);
      return {at_zero + slope * m.xx, at_zero + slope * m.zz, slope * m.xz};
    };
    Matrix out = applied([&](double eigenvalue) { return grid.solved(eigenvalue); });
    if (grid.is_coarsest) return out;
    // The transposed transfer of this wave, up to factors of modulus 1, which cancel but for their difference.
    const Complex px = std::polar(0.25 * (1 + std::cos(kx)), kx) * (1.0 + std::polar(1.0, kz));
    const Complex pz = std::polar(0.25 * (1 + std::cos(kz)), kz) * (1.0 + std::polar(1.0, kx));
    const Matrix coarse = cycle(j, k + 1, 2 * kx, 2 * kz);
    const Matrix b{coarse.xx * std::norm(px), coarse.zz * std::norm(pz), std::conj(px) * coarse.xz * pz};
    // S b S
    const Matrix s = applied([&](double eigenvalue) { return grid.rest(eigenvalue); });
    const Complex cross = s.xx * b.xz * std::conj(s.xz);
    out.xx += s.xx * s.xx * b.xx + 2 * cross.real() + std::norm(s.xz) * b.zz;
    const Complex cross_z = s.zz * std::conj(b.xz) * s.xz;
    out.zz += s.zz * s.zz * b.zz + 2 * cross_z.real() + std::norm(s.xz) * b.xx;
    out.xz += s.xx * b.xx * s.xz + s.xx * b.xz * s.zz + s.xz * std::conj(b.xz) * s.xz + s.xz * b.zz * s.zz;
    return out;
  }

  double depth_cells_;
  Poles poles_;
  std::size_t grid_count_;
};

}  // namespace spindrift::sim
