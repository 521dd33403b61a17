// Encoders of single layers: codecs that keep state from frame to frame, one per packed layer and level, and the
// messages around all payloads.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/bitstream/encode/floater_chain.h>
#include <spindrift/bitstream/encode/particle_cells.h>
#include <spindrift/bitstream/encode/plane_chain.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

#include "frame_checks.h"

namespace spindrift::codec {

/// Serializes one layer of the frame at one level. Tick, times and state id come from `frame`, the codec's header from
/// `codec`, which has no other field set. Without `base_tick` the message is a keyframe. The payload is copied exactly
/// once.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, core::Level level,
                                 std::optional<std::uint64_t> base_tick, const v1::LayerFrame& codec,
                                 core::ByteView payload);

/// Serializes the frame's diagnostics; null if the frame has no diagnostics. Values pass unchanged, including
/// non-finite ones, because clients must see them.
core::SharedBytes serializeDiagnostics(const core::FrameView& frame);

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

/// FloatersPredicted.
class PackedFloaters {
 public:
  /// Returns null messages if the frame lacks the layer. Without `wants_keyframe` the keyframe is omitted if there is a
  /// delta.
  EncodedFrame encode(const core::FrameView& frame, core::Level level, bool wants_keyframe);

 private:
  FloaterChainEncoder chain_;
  std::uint64_t tick_ = 0;  ///< of the newest encoded frame
};

}  // namespace spindrift::codec
