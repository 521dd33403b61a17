// The data plane's encoder: one frame of a room in, one immutable message a layer out, shared by every client.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::stream {

/// Serialized ServerMessages of one frame of a layer. Both null where the frame lacks the layer.
struct EncodedFrame {
  core::SharedBytes whole;       ///< a keyframe
  core::SharedBytes continuing;  ///< for whoever has the frame that was encoded before it; null: no such form
};

/// How one layer becomes bytes. A new codec is a new implementation handed to FrameEncoder; nothing else changes.
/// Owned and called by one thread; may keep state between frames.
class LayerCodec {
 public:
  virtual ~LayerCodec() = default;
  virtual v1::Layer layer() const = 0;
  virtual v1::Packing packing() const { return v1::PACKING_PLAIN; }
  /// Keeps nothing of the frame's memory. Without `wants_whole` the whole form is left out where there is another one.
  virtual EncodedFrame encode(const core::FrameView& frame, bool wants_whole) = 0;
};

/// Plain: the words as the GPU packed them, copied once into the message. Every frame is a keyframe.
std::unique_ptr<LayerCodec> makeSurfaceFixed16Codec();
std::unique_ptr<LayerCodec> makeParticlesFixed12Codec();
std::unique_ptr<LayerCodec> makeFoamFixed8Codec();
std::unique_ptr<LayerCodec> makeBodiesFixed28Codec();
std::unique_ptr<LayerCodec> makeDiagnosticsCodec();
/// Packed: SurfacePredicted.
std::unique_ptr<LayerCodec> makeSurfacePredictedCodec();
/// Packed: FoamPredicted.
std::unique_ptr<LayerCodec> makeFoamPredictedCodec();
/// Packed: ParticlesByCell.
std::unique_ptr<LayerCodec> makeParticlesByCellCodec();

/// A layer in one packing: what a client watches. A layer without a packed form has one stream.
struct Stream {
  v1::Layer layer = v1::LAYER_UNSPECIFIED;
  v1::Packing packing = v1::PACKING_PLAIN;
};
inline constexpr std::size_t kStreamCount = 2 * v1::Layer_ARRAYSIZE;
/// 0 .. kStreamCount - 1; plain ones are numbered as their layers.
constexpr std::size_t indexOf(Stream stream) {
  return static_cast<std::size_t>(stream.packing) * v1::Layer_ARRAYSIZE + static_cast<std::size_t>(stream.layer);
}
/// The stream that a subscription means: plain where the layer has no packed form.
Stream streamOf(v1::Layer layer, v1::Packing packing);
/// Every stream that there is.
std::span<const Stream> allStreams();

/// The codecs of one room. Methods from one thread (the encoder's), except encodeCount(): any thread.
class FrameEncoder {
 public:
  /// A codec for every stream.
  FrameEncoder();
  /// One codec a stream; of two for the same stream the later one counts.
  explicit FrameEncoder(std::vector<std::unique_ptr<LayerCodec>> codecs);

  /// Nothing where the frame lacks the layer or no codec is there for it.
  EncodedFrame encode(Stream stream, const core::FrameView& frame, bool wants_whole);
  /// The plain form.
  core::SharedBytes encode(v1::Layer layer, const core::FrameView& frame) { return encode({layer}, frame, true).whole; }

  /// Frames encoded for the stream so far: one a frame, however many clients watch.
  std::uint64_t encodeCount(Stream stream) const;

 private:
  void add(std::unique_ptr<LayerCodec> codec);

  struct Slot {
    std::unique_ptr<LayerCodec> codec;
    std::atomic<std::uint64_t> encode_count{0};
  };
  std::array<Slot, kStreamCount> slots_;
};

}  // namespace spindrift::stream
