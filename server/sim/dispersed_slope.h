// The dispersion of the wave on the device: F grad(eta) at every face, by one V-cycle (sim_setup/dispersion.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim_setup/dispersion.h>

#include "creation.h"

namespace spindrift::sim {

/// Cells that an invocation of its passes owns, and the sides of the basin.
struct StripShape {
  CellCounts cells;
  bool is_periodic_x, is_periodic_z;

  /// Returns the strips of a grid of so many cells.
  [[nodiscard]] CellCounts stripsOf(CellCounts grid) const {
    return {(grid.x + cells.x - 1) / cells.x, (grid.z + cells.z - 1) / cells.z};
  }
};

class DispersedSlope {
 public:
  /// `keeps_last_step`: with a nonlinear bulk, which needs it.
  DispersedSlope(Creation& create, const WaveLayout& layout, const Dispersion& dispersion, bool keeps_last_step);
  /// Uploads the tables for a changed depth.
  void upload(const Dispersion& dispersion);

  /// Computes texels() from the slopes of the surface, which the caller has bound for lookups: ELEVATION and, if the
  /// scene has one, PRESSURE_HEAD, nx x nz [units]; with a nonlinear bulk SURFACE_RISE, nx x nz x 2 [units per cell].
  void compute();
  /// nx x nz x 2: F grad(eta) at the faces that a cell owns [m * units per cell]. If it keeps the last step, nx x nz x
  /// 4: the same of the last step behind, which a nonlinear bulk takes into the next one (wave/dispersed_share.glsl).
  [[nodiscard]] gpu::TexelBuffer& texels() { return dispersed_; }
  void declareState(StateBuffers& out);

 private:
  /// Strips of a grid that one dispatch takes (shaders/dispersion/strip.glsl).
  struct Strips {
    gpu::TexelBuffer list;
    std::uint32_t count = 0;
  };
  struct Grid {
    CellCounts count;
    gpu::Buffer sizes;                       ///< shared::DispersionUniforms
    gpu::TexelBuffer coefficients, weights;  ///< none in the last grid; no weights in a flat basin
    Strips strips[2];                        ///< of an uneven basin: by whether they are steady
    gpu::TexelBuffer right, faces;           ///< except on the finest grid
  };

  void bindTables(std::size_t level);
  void descend(std::size_t level);
  void solveBottom();
  void ascend(std::size_t level);
  void run(Pass (&passes)[2], std::size_t level);

  StripShape strip_;
  bool is_flat_;
  bool keeps_last_step_;
  std::vector<Grid> grids_;  ///< finest first; the last one is the first of the bottom
  /// Tables of the grids that one work group solves, one grid behind the other.
  std::vector<gpu::TexelBuffer> bottom_tables_;
  gpu::TexelBuffer dispersed_;
  Pass descend_[2][2], ascend_[2][2];  ///< by whether the grid is the finest, and the strips are steady
  Pass solve_bottom_;
};

}  // namespace spindrift::sim
