// The dispersion of the wave on the device: F grad(eta) at every face, by one V-cycle (sim_setup/dispersion.h).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/dispersion.h>

namespace spindrift::sim {

class DispersedSlope {
 public:
  /// Errors: those of the buffers and programs.
  static core::Result<std::unique_ptr<DispersedSlope>> create(gpu::Context& ctx, const WaveLayout& layout,
                                                              const Basin& basin, const gpu::Defines& defines);
  /// Uploads the tables for a changed depth.
  void upload(const WaveLayout& layout, const Basin& basin);

  /// Computes texels() from the elevation and the pressure head (null: none), n x n [units].
  void compute(const gpu::TexelBuffer& elevation, const gpu::TexelBuffer* pressure_head);
  /// n x n x 2: F grad(eta) at the faces that a cell owns [m * units per cell].
  [[nodiscard]] const gpu::TexelBuffer& texels() const { return dispersed_; }

 private:
  /// The buffers of one grid with its own dispatches, or of the grids at the bottom, one behind the other.
  struct Grid {
    std::uint32_t side_count = 0;
    gpu::TexelBuffer stiffness;
    gpu::TexelBuffer from_x, from_z;
    gpu::TexelBuffer right, faces;  ///< except on the finest grid
  };

  explicit DispersedSlope(gpu::Context& ctx) : ctx_(ctx) {}
  void upload(const Dispersion& dispersion);
  void bindTables(const Grid& grid, bool is_finest);
  void descend(std::size_t level);
  void solveBottom();
  void ascend(std::size_t level);
  void dispatch(gpu::Program& pass, const Grid& grid);

  gpu::Context& ctx_;
  std::vector<Grid> grids_;          ///< finest first; the last one is the bottom
  gpu::TexelBuffer bottom_weights_;  ///< of the sweeps at the bottom
  gpu::TexelBuffer root_c_, dispersed_;
  /// By whether the grid is the finest.
  gpu::Program descend_[2], ascend_[2];
  gpu::Program bottom_;
};

}  // namespace spindrift::sim
