// The data plane's encoder: one frame of a room in, one immutable message a layer out, shared by every client.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::stream {

/// How one layer becomes bytes. A new codec is a new implementation handed to FrameEncoder; nothing else changes.
/// Owned and called by one thread; may keep state between frames.
class LayerCodec {
 public:
  virtual ~LayerCodec() = default;
  virtual v1::Layer layer() const = 0;
  /// A whole serialized ServerMessage, or null where the frame lacks the layer. Keeps nothing of the frame's memory.
  virtual core::SharedBytes encode(const core::FrameView& frame) = 0;
  /// The next frame must stand by itself: somebody joined, or lost the frame that the next one would build on.
  virtual void requestKeyframe() = 0;
};

/// Fixed width: the words as the GPU packed them, copied once into the message. Every frame is a keyframe.
std::unique_ptr<LayerCodec> makeSurfaceFixed16Codec();
std::unique_ptr<LayerCodec> makeParticlesFixed12Codec();
std::unique_ptr<LayerCodec> makeFoamFixed8Codec();
std::unique_ptr<LayerCodec> makeBodiesFixed28Codec();
std::unique_ptr<LayerCodec> makeDiagnosticsCodec();

/// The codecs of one room. Methods from one thread (the encoder's), except encodeCount(): any thread.
class FrameEncoder {
 public:
  /// The fixed-width codecs and diagnostics.
  FrameEncoder();
  /// One codec a layer; of two for the same layer the later one counts.
  explicit FrameEncoder(std::vector<std::unique_ptr<LayerCodec>> codecs);

  /// A serialized ServerMessage; null where the frame lacks the layer or no codec is there for it.
  core::SharedBytes encode(v1::Layer layer, const core::FrameView& frame);
  core::SharedBytes encodeSurface(const core::FrameView& frame) { return encode(v1::LAYER_SURFACE, frame); }
  core::SharedBytes encodeParticles(const core::FrameView& frame) { return encode(v1::LAYER_PARTICLES, frame); }
  core::SharedBytes encodeDiagnostics(const core::FrameView& frame) { return encode(v1::LAYER_DIAGNOSTICS, frame); }

  void requestKeyframe(v1::Layer layer);

  /// Messages encoded for the layer so far: one a frame, however many clients watch.
  std::uint64_t encodeCount(v1::Layer layer) const;

 private:
  struct Slot {
    std::unique_ptr<LayerCodec> codec;
    std::atomic<std::uint64_t> encode_count{0};
  };
  std::array<Slot, v1::Layer_ARRAYSIZE> slots_;
};

}  // namespace spindrift::stream
