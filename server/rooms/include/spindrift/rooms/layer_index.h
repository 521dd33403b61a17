// The network knows layers by number: here a stream gets its own.
#pragma once

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/net/server.h>

namespace spindrift::rooms {

static_assert(codec::kStreamCount <= net::kMaxLayerCount);

inline net::LayerIndex layerIndex(codec::Stream stream) {
  return static_cast<net::LayerIndex>(codec::indexOf(stream));
}

}  // namespace spindrift::rooms
