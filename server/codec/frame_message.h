// Serializes the layers of a frame as ServerMessages.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// `codec` holds only the codec's member. Without `base_tick` the frame is a keyframe. The payload is copied exactly
/// once.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, std::optional<std::uint64_t> base_tick,
                                 const v1::LayerFrame& codec, core::ByteView payload);

/// Serializes the frame's diagnostics; null if there are none. Values pass unchanged, including non-finite ones,
/// because clients must see them.
core::SharedBytes serializeDiagnostics(const core::FrameView& frame);

}  // namespace spindrift::codec
