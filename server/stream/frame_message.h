// A layer's frame as the bytes of a ServerMessage.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/bytes.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::stream {

/// `codec` holds the codec's member and nothing else. Without `base_tick` the frame is a keyframe. The payload is
/// copied exactly once.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, std::optional<std::uint64_t> base_tick,
                                 const v1::LayerFrame& codec, core::ByteView payload);

}  // namespace spindrift::stream
