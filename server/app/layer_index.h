// The network knows layers by number: here a stream gets its own.
#pragma once

#include <spindrift/net/server.h>
#include <spindrift/stream/frame_encoder.h>

namespace spindrift::app {

static_assert(stream::kStreamCount <= net::kMaxLayerCount);

inline net::LayerIndex layerIndex(stream::Stream stream) {
  return static_cast<net::LayerIndex>(stream::indexOf(stream));
}

}  // namespace spindrift::app
