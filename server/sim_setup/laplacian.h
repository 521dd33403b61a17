// The operator whose slowest motions the coarse grids of the dispersion are fitted to.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "dispersion_grid.h"

namespace spindrift::sim {

using Cells = std::vector<double>;                 ///< one value per cell
using Faces = std::vector<std::array<double, 2>>;  ///< one value per x and z face

constexpr std::size_t kMotionCount = 4;
/// Values of two motions: a vector of the compiler, which every processor has registers for.
using Two [[gnu::vector_size(2 * sizeof(double))]] = double;
/// Levels of two motions, one entry per cell. Motions do not know of each other, and one pass over the memory serves
/// two.
using Levels = std::vector<Two>;
using Pairs = std::array<Levels, kMotionCount / 2>;

/// -div d grad on a grid, with the wet shares as areas; lengths in cells of the grid.
class Laplacian {
 public:
  explicit Laplacian(const DispersionGrid& grid)
      : nx_(static_cast<std::size_t>(grid.nx)),
        nz_(static_cast<std::size_t>(grid.nz)),
        wet_(grid.wet),
        conductance_m_(grid.wet.size()) {
    std::size_t open_count = 0;
    double sum_m = 0.0;
    for (std::size_t i = 0; i < wet_.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (grid.open[i][axis] <= 0.0) continue;
        conductance_m_[i][axis] = grid.open[i][axis] / grid.resistance_pm[i][axis];
        sum_m += conductance_m_[i][axis];
        ++open_count;
      }
    }
    if (open_count > 0) mean_m_ = sum_m / static_cast<double>(open_count);
  }

  /// Fluxes that belong to the levels of one motion: up the slope.
  [[nodiscard]] Faces flux(const Levels& level, std::size_t motion) const {
    Faces out(level.size());
    for (std::size_t z = 0; z < nz_; ++z) {
      for (std::size_t x = 0; x < nx_; ++x) {
        const std::size_t i = x + nx_ * z;
        const double here = level[i][motion];
        out[i] = {conductance_m_[i][0] * (level[east(x, z)][motion] - here),
                  conductance_m_[i][1] * (level[north(x, z)][motion] - here)};
      }
    }
    return out;
  }

  [[nodiscard]] double wet(std::size_t cell) const { return wet_[cell]; }

  /// Squares of the levels, by area.
  void findSquares(const Levels& level, Two& out) const {
    out = Two{};
    for (std::size_t i = 0; i < level.size(); ++i) out += level[i] * (level[i] * wet_[i]);
  }

  [[nodiscard]] Levels weighted(Levels level, const Two& factor) const {
    for (std::size_t i = 0; i < level.size(); ++i) level[i] = level[i] * wet_[i] * factor;
    return level;
  }

  /// <level, -div d grad level>/<level, level> [m]; 0 for a level of 0.
  void findEigenvalues(const Levels& level, Two& out) const {
    Two energy{};
    for (std::size_t z = 0; z < nz_; ++z)
      forRow(z, level, Two{}, [&](std::size_t i, const Two& image) { energy += level[i] * image; });
    Two square;
    findSquares(level, square);
    out = square > 0.0 ? energy / square : Two{};
  }

  [[nodiscard]] double meanConductance() const { return mean_m_; }

  /// Improves solutions of (-div d grad + shift) level = right by conjugate gradients with the diagonal as
  /// preconditioner; `rest`: the right side. A motion whose shift is not above 0 keeps its level.
  void improve(Levels& level, Levels rest, const Two& shift, int iterations) const {
    const auto scale = [&](std::size_t x, std::size_t z, const Two& value, Two& out) {
      const std::size_t i = x + nx_ * z;
      Two diagonal = shift * wet_[i];
      forFaces(x, z, [&](std::size_t owner, std::size_t axis, bool) { diagonal += conductance_m_[owner][axis]; });
      out = diagonal > 0.0 ? value / diagonal : Two{};
    };
    Two square{};
    Levels direction(level.size());
    for (std::size_t z = 0; z < nz_; ++z) {
      forRow(z, level, shift, [&](std::size_t i, const Two& image) {
        rest[i] -= image;
        scale(i - nx_ * z, z, rest[i], direction[i]);
        square += rest[i] * direction[i];
      });
    }
    Two turn{};  // share of the last direction in the next one
    const auto turnRow = [&](std::size_t z) {
      for (std::size_t x = 0; x < nx_; ++x) {
        Two next;
        scale(x, z, rest[x + nx_ * z], next);
        direction[x + nx_ * z] = next + turn * direction[x + nx_ * z];
      }
    };
    for (int k = 0; k < iterations; ++k) {
      const auto goes_on = (square > 0.0) & (shift > 0.0);
      if (!goes_on[0] && !goes_on[1]) return;
      // The row behind a row, which may be beyond a periodic side, is turned before the image of the row.
      Two along{};
      if (k > 0) turnRow(nz_ - 1);
      if (k > 0 && nz_ > 1) turnRow(0);
      for (std::size_t z = 0; z < nz_; ++z) {
        if (k > 0 && z + 2 < nz_) turnRow(z + 1);
        forRow(z, direction, shift, [&](std::size_t i, const Two& image) { along += direction[i] * image; });
      }
      const Two step = goes_on ? square / along : Two{};
      Two now{};
      for (std::size_t z = 0; z < nz_; ++z) {
        forRow(z, direction, shift, [&](std::size_t i, const Two& image) {
          level[i] += step * direction[i];
          rest[i] -= step * image;
          Two scaled;
          scale(i - nx_ * z, z, rest[i], scaled);
          now += rest[i] * scaled;
        });
      }
      turn = goes_on ? now / square : Two{};
      square = goes_on ? now : Two{};
    }
  }

 private:
  [[nodiscard]] std::size_t east(std::size_t x, std::size_t z) const { return (x + 1 < nx_ ? x + 1 : 0) + nx_ * z; }
  [[nodiscard]] std::size_t north(std::size_t x, std::size_t z) const { return x + nx_ * (z + 1 < nz_ ? z + 1 : 0); }

  /// Visits the faces of a cell in the order of the cells that own them: with that cell, the axis, and whether the cell
  /// owns it itself. Every sum over faces has this order, so that its rounding does.
  template <class Visit>
  void forFaces(std::size_t x, std::size_t z, const Visit& visit) const {
    const std::size_t i = x + nx_ * z;
    if (z > 0) visit(i - nx_, 1, false);
    if (x > 0) visit(i - 1, 0, false);
    visit(i, 0, true);
    visit(i, 1, true);
    if (x == 0) visit(i + nx_ - 1, 0, false);
    if (z == 0) visit(i + nx_ * (nz_ - 1), 1, false);
  }

  /// Calls take(cell, (-div d grad + shift) level) for the cells of a row.
  template <class Take>
  void forRow(std::size_t z, const Levels& level, const Two& shift, const Take& take) const {
    for (std::size_t x = 0; x < nx_; ++x) {
      const std::size_t i = x + nx_ * z;
      const Two here = level[i];
      Two out = shift * wet_[i] * here;
      forFaces(x, z, [&](std::size_t owner, std::size_t axis, bool is_own) {
        const double conductance_m = conductance_m_[owner][axis];
        const Two& there = is_own ? level[axis == 0 ? east(x, z) : north(x, z)] : level[owner];
        out += conductance_m * (here - there);
      });
      take(i, out);
    }
  }

  std::size_t nx_, nz_;
  const Cells& wet_;
  Faces conductance_m_;  ///< 0 where closed
  double mean_m_ = 0.0;  ///< of the open faces
};

}  // namespace spindrift::sim
