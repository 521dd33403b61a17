// Maps streams to the layer numbers of the network, and calls the hub for them.
#pragma once

#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/net/server.h>

namespace spindrift::service {

static_assert(codec::kStreamCount <= net::kMaxStreamCount);

inline net::StreamIndex streamIndex(codec::Stream stream) {
  return static_cast<net::StreamIndex>(codec::indexOf(stream));
}

/// Publishes on a hub, for FrameOutlet::publish().
inline void publishTo(net::Hub& hub, const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                      const core::FrameLevels& levels) {
  hub.publish(room, streamIndex(stream), {.keyframe = frame.keyframe, .delta = frame.delta, .levels = levels});
}

}  // namespace spindrift::service
