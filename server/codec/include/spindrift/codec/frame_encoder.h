// Encoder of the data plane: makes one immutable message per layer from a frame of a room, shared by all clients.
#pragma once

#include <memory>

#include <spindrift/codec/stream.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Serialized ServerMessages of one frame of a layer. Both null if the frame lacks the layer.
struct EncodedFrame {
  core::SharedBytes keyframe;  ///< can be decoded alone
  core::SharedBytes delta;     ///< for clients that have the previously encoded frame; null for a keyframe alone
};

/// The codecs of one room. Call the methods on one thread, the encoder thread.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();

  /// Encodes one level of the frame. Returns null messages if the frame lacks the layer at this level. Layers without
  /// levels are encoded at core::Level::kFull only. Without `wants_keyframe` the keyframe is omitted if there is a
  /// delta.
  EncodedFrame encode(Stream stream, const core::FrameView& frame, core::Level level, bool wants_keyframe);
  /// Encodes the plain form at core::Level::kFull.
  core::SharedBytes encode(v1::Layer layer, const core::FrameView& frame) {
    return encode({layer}, frame, core::Level::kFull, true).keyframe;
  }

 private:
  struct Packed;
  std::unique_ptr<Packed[]> packed_;  ///< indexed by core::Level
};

/// Returns the bytes of a message.
core::SharedBytes serialized(const google::protobuf::MessageLite& message);

/// Writes what a gauge measured: in Diagnostics and in answers of the REST interface.
void writeGauge(const core::DiagnosticsView::GaugeNow& gauge, v1::GaugeReading& out);

}  // namespace spindrift::codec
