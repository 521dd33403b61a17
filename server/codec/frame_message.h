// Serializes the layers of a frame as ServerMessages.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Serializes one layer of the frame at one level. Tick, times and state id come from `frame`, the codec's header from
/// `codec`, which has no other field set. Without `base_tick` the message is a keyframe. The payload is copied exactly
/// once.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, core::Level level,
                                 std::optional<std::uint64_t> base_tick, const v1::LayerFrame& codec,
                                 core::ByteView payload);

/// Serializes the frame's diagnostics; null if the frame has no diagnostics. Values pass unchanged, including
/// non-finite ones, because clients must see them.
core::SharedBytes serializeDiagnostics(const core::FrameView& frame);

}  // namespace spindrift::codec
