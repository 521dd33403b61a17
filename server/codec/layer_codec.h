// Interface of the codecs: one layer in one packing at one level to bytes. A new codec is a new implementation in
// FrameEncoder's list; nothing else changes.
#pragma once

#include <memory>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/frame_view.h>

namespace spindrift::codec {

/// Owned and called by one thread; may keep state between frames.
class LayerCodec {
 public:
  virtual ~LayerCodec() = default;
  /// Encodes the codec's layer of the frame at one level, the same one in every call. Returns null messages if the
  /// frame lacks it. Keeps no reference to the frame's memory. Without `wants_keyframe` the keyframe is omitted if
  /// there is a delta.
  virtual EncodedFrame encode(const core::FrameView& frame, core::Level level, bool wants_keyframe) = 0;
};

/// SurfacePredicted.
std::unique_ptr<LayerCodec> makeSurfacePredictedCodec();
/// FoamPredicted.
std::unique_ptr<LayerCodec> makeFoamPredictedCodec();
/// ParticlesByCell.
std::unique_ptr<LayerCodec> makeParticlesByCellCodec();

}  // namespace spindrift::codec
