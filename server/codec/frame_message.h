// A frame's layers as the bytes of ServerMessages.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// `codec` holds the codec's member and nothing else. Without `base_tick` the frame is a keyframe. The payload is
/// copied exactly once.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, std::optional<std::uint64_t> base_tick,
                                 const v1::LayerFrame& codec, core::ByteView payload);

/// The frame's diagnostics; null where the frame has none. Values pass unchanged, non-finite ones as well: a client
/// must see them.
core::SharedBytes serializeDiagnostics(const core::FrameView& frame);

}  // namespace spindrift::codec
