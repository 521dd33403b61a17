// Dispersion of the wave: an operator F on the faces that takes the place of the face depth in the momentum step, so
// that waves follow omega^2 = g k tanh(k d). Pure functions of the basin; docs/dispersion.md derives them.
//
//   q_t = -g F grad(eta),   F = a + sum_j sqrt(c_j) (1/d - grad (b_j d) div)^-1 sqrt(c_j)
//
// Every factor is symmetric and positive, so the leapfrog conserves energy over any bed and beside any wall, and a wave
// that runs into shallow water keeps its energy flux. The inverse is one V(2,2) cycle of a multigrid method from zero.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <shared/groups.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Rational terms of F. Two fit in one texel of a cell: (x face, z face) times two.
inline constexpr std::size_t kPoleCount = 2;

/// Returns a/d: what is left of F for the shortest waves. It is the limit of a term with b = 0, and costs no solution.
[[nodiscard]] double shareAtOnce(double depth_cells);

/// Coefficients at one depth: b_j and c_j of the formula above.
struct Poles {
  std::array<double, kPoleCount> b{};
  std::array<double, kPoleCount> c{};
};

/// Returns the coefficients for water of this depth in cells, fitted to the phase speeds that the V-cycle has (tool
/// tests/tools/fit_dispersion.cpp): within 1 % for waves of 8 cells and longer and 2.5 % for 4 cells, for depths of 1
/// to 45 cells and kd up to 10.
[[nodiscard]] Poles polesAt(double depth_cells);

/// One grid of the V-cycle: n x n cells, x fastest. Each cell owns the faces toward +x and +z. A face variable is the
/// flux through the open part of the face per width of the whole face. Arrays of four: x face of pole 0 and 1, then z
/// face of pole 0 and 1.
struct DispersionLevel {
  std::uint32_t side_count = 0;
  /// 1/d of the x face and of the z face (of coarse faces beside walls: their resistance), over their open share; b_0 d
  /// and b_1 d of the cell, over its wet share and the squared cell size of this grid; all times the scene's depth. 0
  /// where closed or dry.
  std::vector<std::array<double, 4>> stiffness;
  /// Weights of the x and the z face in the coarser grid's faces E, W, N, S of the same block. Empty in the coarsest
  /// grid.
  std::vector<std::array<double, 4>> from_coarse_x;
  std::vector<std::array<double, 4>> from_coarse_z;

  [[nodiscard]] std::size_t index(int x, int z) const {
    const int n = static_cast<int>(side_count);
    return static_cast<std::size_t>((x + n) % n + n * ((z + n) % n));
  }
};

/// All numbers fit in 16 bits (roundToHalf()), except where the basin is flat.
struct Dispersion {
  double depth_m = 0.0;  ///< the scene's
  double cell_m = 0.0;
  /// Finest first, at least two. The resolution alone decides how many.
  std::vector<DispersionLevel> levels;
  std::vector<std::array<double, 4>> root_c;  ///< sqrt(c_j * scene's depth [m]) on the finest faces; 0 where closed
  bool is_flat = false;                       ///< as in Basin
};

/// Weight of the damped Jacobi sweeps.
inline constexpr double kSweepWeight = DISPERSION_SWEEP_WEIGHT;
/// Sweeps before and after the coarser grid, and in the coarsest one.
inline constexpr int kSweepCount = 2;
inline constexpr int kCoarsestSweepCount = DISPERSION_COARSEST_SWEEPS;
/// One work group solves the grids from kBottomSide cells per side down, or the coarsest grid alone if it has more, up
/// to kBottomSideMax.
inline constexpr std::uint32_t kBottomSide = DISPERSION_BOTTOM_SIDE;
inline constexpr std::uint32_t kBottomSideMax = DISPERSION_BOTTOM_SIDE_MAX;

/// Returns whether a wave of so many cells per side can be halved down to the grids of the bottom.
[[nodiscard]] bool canDisperse(std::uint32_t resolution_count);

/// Bytes of its buffers on the device, at most.
[[nodiscard]] std::uint64_t dispersionBytes(std::uint32_t resolution_count);

/// Largest stable step [s]: 2 over the highest frequency of the grid, with the dispersion's coefficients at any depth
/// up to depth_m, with a margin.
[[nodiscard]] double dispersedMaxStep(double gravity_mps2, double depth_m, double cell_m);

/// Lays out the grids for a basin with the 5-point stencil. Precondition: canDisperse(). `poles`: other coefficients,
/// to fit them.
[[nodiscard]] Dispersion layOutDispersion(const WaveLayout& layout, const Basin& basin,
                                          const std::function<Poles(double depth_cells)>& poles = polesAt);

/// kSweepWeight over the diagonal of the operator for each face of a grid, over the scene's depth; 0 where closed.
[[nodiscard]] std::vector<std::array<double, 4>> sweepWeights(const DispersionLevel& level);

}  // namespace spindrift::sim
