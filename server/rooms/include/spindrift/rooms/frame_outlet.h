// Where encoded frames go, and which of them are needed.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/level.h>
#include <spindrift/core/level_demand.h>

namespace spindrift::rooms {

/// Called on the encoder's thread; must not block.
class FrameOutlet {
 public:
  virtual ~FrameOutlet() = default;

  /// What the sessions that watch a stream of a room need of its next frame. `reduced_count`: levels of the layer from
  /// this one on are all kFull.
  [[nodiscard]] virtual core::LayerDemand demand(const std::string& room, codec::Stream stream,
                                                 std::uint32_t reduced_count) const = 0;
  /// One level of a frame, to every session that watches it.
  virtual void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                       core::Level level, std::uint32_t reduced_count) = 0;
};

}  // namespace spindrift::rooms
