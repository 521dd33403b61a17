// The dispersion of the wave on the device: F grad(eta) at every face, by one V-cycle (sim_setup/dispersion.h).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

class DispersedSlope {
 public:
  /// `keeps_last_step`: with a nonlinear bulk, which needs it. Errors: those of the buffers and programs.
  static core::Result<std::unique_ptr<DispersedSlope>> create(gpu::Context& ctx, const WaveLayout& layout,
                                                              const Basin& basin, const gpu::Defines& defines,
                                                              bool keeps_last_step);
  /// Uploads the tables for a changed depth.
  void upload(const WaveLayout& layout, const Basin& basin);

  /// Computes texels() from the slopes of the surface, which the caller has bound for lookups: ELEVATION and, if the
  /// scene has one, PRESSURE_HEAD, nx x nz [units]; with a nonlinear bulk SURFACE_RISE, nx x nz x 2 [units per cell].
  void compute();
  /// nx x nz x 2: F grad(eta) at the faces that a cell owns [m * units per cell]. If it keeps the last step, nx x nz x
  /// 4: the same of the last step behind, which a nonlinear bulk takes into the next one (wave/dispersed_share.glsl).
  [[nodiscard]] gpu::TexelBuffer& texels() { return dispersed_; }
  void declareState(StateBuffers& out);

 private:
  struct Grid {
    CellCounts count;
    gpu::Buffer sizes;                       ///< shared::DispersionUniforms
    gpu::TexelBuffer coefficients, weights;  ///< none in the last grid; no weights in a flat basin
    gpu::TexelBuffer right, faces;           ///< except on the finest grid
  };

  /// The grids that one work group solves: their tables, one behind the other.
  struct Bottom {
    gpu::TexelBuffer stiffness, spread, sweep, from_x, from_z;
    gpu::Program solve;
  };

  DispersedSlope(gpu::Context& ctx, bool keeps_last_step) : ctx_(ctx), keeps_last_step_(keeps_last_step) {}
  void upload(const Dispersion& dispersion);
  void bindTables(std::size_t level);
  void descend(std::size_t level);
  void solveBottom();
  void ascend(std::size_t level);
  void dispatch(gpu::Program& pass, std::size_t level);

  gpu::Context& ctx_;
  bool keeps_last_step_;
  std::vector<Grid> grids_;  ///< finest first; the last one is the first of the bottom
  Bottom bottom_;
  gpu::TexelBuffer dispersed_;
  gpu::Program descend_[2], ascend_[2];  ///< by whether the grid is the finest
};

}  // namespace spindrift::sim
