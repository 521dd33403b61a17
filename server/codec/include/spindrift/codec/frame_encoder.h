// Encoder of the data plane: makes one immutable message per layer from a frame of a room, shared by all clients.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include <spindrift/codec/stream.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

class LayerCodec;

/// Serialized ServerMessages of one frame of a layer. Both null where the frame lacks the layer.
struct EncodedFrame {
  core::SharedBytes keyframe;  ///< stands by itself
  core::SharedBytes delta;     ///< for clients that have the frame encoded before it; null: none
};

/// The codecs of one room: one for each stream and level, made when it is first asked for. Methods from one thread (the
/// encoder's), except encodeCount(): any thread.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();

  /// Encodes a frame of one level (core::frameAt). Nothing where it lacks the layer.
  EncodedFrame encode(Stream stream, const core::FrameView& frame, bool wants_keyframe);
  /// The plain form.
  core::SharedBytes encode(v1::Layer layer, const core::FrameView& frame) {
    return encode({layer}, frame, true).keyframe;
  }

  /// Frames of the stream encoded so far: one a level and frame, however many clients watch.
  std::uint64_t encodeCount(Stream stream) const;

 private:
  struct Slot {
    std::array<std::unique_ptr<LayerCodec>, core::kLevelCount> codecs;
    std::atomic<std::uint64_t> encode_count{0};
  };
  std::array<Slot, kStreamCount> slots_;
};

}  // namespace spindrift::codec
