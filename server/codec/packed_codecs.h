// Codecs that keep state from frame to frame: one per packed layer and level.
#pragma once

#include <cstdint>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>

#include "encode/particle_cells.h"
#include "encode/plane_chain.h"
#include "frame_checks.h"

namespace spindrift::codec {

/// SurfacePredicted or FoamPredicted.
class PackedPlanes {
 public:
  /// Returns null messages if the frame lacks the layer. Without `wants_keyframe` the keyframe is omitted if there is a
  /// delta.
  EncodedFrame encode(const core::FrameView& frame, v1::Layer layer, core::Level level, bool wants_keyframe);

 private:
  template <typename Sample, typename View, typename Header>
  EncodedFrame encode(const core::FrameView& frame, v1::Layer layer, core::Level level, bool wants_keyframe,
                      const View& view, double quantum_m, Header* (v1::LayerFrame::*header_of)());

  PlaneChainEncoder chain_;
  PlaneExtents extents_;
  double quantum_m_ = 0.0;
  std::uint64_t tick_ = 0;  ///< of the newest encoded plane
};

/// ParticlesByCell.
class PackedParticles {
 public:
  /// Null if the frame lacks the layer.
  core::SharedBytes encode(const core::FrameView& frame, core::Level level);

 private:
  ParticleCellsEncoder cells_;
  ResidualEncoder residuals_;
  core::Bytes payload_;
};

}  // namespace spindrift::codec
