// The wave equation on the device: integer elevations, the flow through the faces between cells, and the surface as
// particles and boats see it. A step is momentum, then continuity: eliminating the flow gives the leapfrog on three
// elevation levels of the thesis (3.4, 3.6.3), to the same dispersion relation, and keeps the volume to the last unit.
#pragma once

#include <memory>

#include <shared/event_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

class Wave {
 public:
  /// `sampled`: particles or boats look at the surface; also makes what they read. Tables for the basin only where it
  /// is varied, outflow only where it is open.
  static core::Result<std::unique_ptr<Wave>> create(gpu::Context& ctx, const core::Scene& scene,
                                                    const WaveLayout& layout, const gpu::Defines& defines,
                                                    bool sampled);

  /// Level and still, nothing has flowed out.
  void clear();
  /// The surface has no external pressure until a caller adds to pressureHead().
  void clearPressure();
  /// Tables for changed parameters (depth, gravity).
  void uploadBasin(const core::Scene& scene, const WaveLayout& layout);

  /// Multiplies the flow everywhere. Waits: for what people rarely do.
  void scaleFlow(double ratio);
  /// After the bed has risen (shallower water, an older checkpoint): cells whose surface lies below it are filled up to
  /// it with water of the others, in proportion to what these hold; where sides are open and there is too little, with
  /// water from outside, counted as outflow. Not a unit is made or lost. Waits: for what people rarely do.
  void fillUpToBed(const core::Scene& scene, const WaveLayout& layout);

  /// One wave step: what the slope sets in motion and what this step's share of the active effects displaces, limited
  /// to what cells hold. `breaking` may be null; empty `events` say that no effect acts now.
  void advance(const gpu::TexelBuffer* breaking, const shared::EventUniforms& events);
  /// Slopes, vertical speed and horizontal velocity of the surface, for particles and boats.
  void sampleSurface();

  [[nodiscard]] gpu::TexelBuffer& elevation() { return elevation_; }  ///< n x n [units]
  [[nodiscard]] gpu::TexelBuffer& flow() { return flow_; }            ///< n x n x 2 (9-point: 4) [m^2/s]
  [[nodiscard]] gpu::TexelBuffer* outflow() {
    return has_outflow_ ? &outflow_ : nullptr;
  }  ///< n x n [units: low 24 bits, the rest]
  /// 2, or 4 with the 9-point stencil.
  [[nodiscard]] std::size_t flowComponents() const { return flow_components_; }
  /// Binds SURFACE and SURFACE_FLOW for lookups. Sampled scenes only.
  void bindSurface() const;
  /// Binds the effects of the last wave step.
  void bindEvents() const;
  /// Binds BASIN and BED where there are tables.
  void bindBasin() const;
  /// Binds TERRAIN and LANDING where there is ground to see.
  void bindTerrain() const;
  /// n x n [units]: hulls and falling particles. Scenes with boats or two-way coupling only.
  [[nodiscard]] gpu::TexelBuffer& pressureHead() { return pressure_head_; }

 private:
  Wave(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), n_(layout.resolution_count), cell_m_(layout.cell_m) {}
  void displace(const shared::EventUniforms& events);
  void displaceBySplashes(const shared::EventUniforms& events);
  void limit();

  gpu::Context& ctx_;
  std::uint32_t n_;
  double cell_m_;
  std::size_t flow_components_ = 2;
  bool is_varied_ = false;
  bool has_outflow_ = false;
  bool had_events_ = false;
  bool has_head_ = false;
  bool has_terrain_ = false;
  gpu::TexelBuffer elevation_, flow_, basin_, bed_, outflow_;
  gpu::TexelBuffer transfer_;     ///< n x n x 2 (9-point: 4) [units]
  gpu::TexelBuffer given_share_;  ///< n x n; written in steps that limit something
  gpu::Buffer limit_args_;        ///< groups of the two passes that limit; none in most steps
  gpu::TexelBuffer pressure_head_, terrain_, landing_;
  gpu::TexelBuffer surface_, surface_flow_;
  gpu::Buffer event_uniforms_;
  gpu::Program splash_, crest_, momentum_, find_share_, limit_, continuity_, sample_surface_;
};

}  // namespace spindrift::sim
