// The wave equation on the device: three elevation levels, and the surface as particles see it.
#pragma once

#include <memory>

#include <shared/event_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

class Wave {
 public:
  /// `coupled`: also allocates and compiles what particles need of the surface.
  static core::Result<std::unique_ptr<Wave>> create(gpu::Context& ctx, const WaveLayout& layout,
                                                    const gpu::Defines& defines, bool coupled);

  /// Adds one wave step's share of the active effects to the two newest levels.
  void inject(const shared::EventUniforms& events);
  /// One leapfrog step: the three levels move up by one.
  void evolve();
  /// Slopes, vertical speed and horizontal flow of the surface, for the particles. Coupled scenes only.
  void sampleSurface();

  [[nodiscard]] gpu::TexelBuffer& elevation() { return level_[1]; }          ///< now, n x n [m]
  [[nodiscard]] gpu::TexelBuffer& elevationPrevious() { return level_[0]; }  ///< one wave step ago
  [[nodiscard]] gpu::TexelBuffer& flow() { return flow_; }                   ///< coupled scenes only
  /// Binds SURFACE and SURFACE_FLOW for floor lookups. Coupled scenes only.
  void bindSurface() const;

 private:
  explicit Wave(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), n_(layout.resolution_count) {}

  gpu::Context& ctx_;
  std::uint32_t n_;
  gpu::TexelBuffer level_[3];  ///< previous, now, next
  gpu::TexelBuffer surface_, flow_;
  gpu::Buffer event_uniforms_;
  gpu::Program inject_, evolve_, sample_surface_;
};

}  // namespace spindrift::sim
