// The receiver of encoded frames.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/level.h>

namespace spindrift::rooms {

/// Called on the encoder thread; must not block.
class FrameOutlet {
 public:
  virtual ~FrameOutlet() = default;

  /// Sends the data of one level of a frame to the sessions that take it. `levels`: which these are.
  virtual void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                       const core::FrameLevels& levels) = 0;
};

}  // namespace spindrift::rooms
