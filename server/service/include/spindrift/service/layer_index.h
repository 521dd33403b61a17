// Maps streams to the layer numbers of the network, and calls the hub for them.
#pragma once

#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/net/server.h>

namespace spindrift::service {

static_assert(codec::kStreamCount <= net::kMaxLayerCount);

inline net::LayerIndex layerIndex(codec::Stream stream) {
  return static_cast<net::LayerIndex>(codec::indexOf(stream));
}

/// FrameOutlet::demand(), forwarded to a hub.
inline core::LayerDemand demandOf(const net::Hub& hub, const std::string& room, codec::Stream stream,
                                  std::uint32_t reduced_count) {
  return hub.demand(room, layerIndex(stream), reduced_count);
}

/// FrameOutlet::publish(), forwarded to a hub.
inline void publishTo(net::Hub& hub, const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                      core::Level level, std::uint32_t reduced_count) {
  hub.publish(room, layerIndex(stream),
              {.keyframe = frame.keyframe, .delta = frame.delta, .level = level, .reduced_count = reduced_count});
}

}  // namespace spindrift::service
