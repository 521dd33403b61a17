// The receiver of encoded frames, which also says which of them are needed.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/level.h>
#include <spindrift/core/level_demand.h>

namespace spindrift::rooms {

/// Called on the encoder thread; must not block.
class FrameOutlet {
 public:
  virtual ~FrameOutlet() = default;

  /// Returns the demand for the next frame of a stream, by the level that sessions ask for; core::demandOfFrame() gives
  /// it by the data that they need. `reduced_count`: number of levels that downsample the layer; others equal kFull.
  [[nodiscard]] virtual core::StreamDemand demand(const std::string& room, codec::Stream stream,
                                                  std::uint32_t reduced_count) const = 0;
  /// Sends the data of one level of a frame to the sessions that take it. `levels`: which these are.
  virtual void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                       const core::FrameLevels& levels) = 0;
};

}  // namespace spindrift::rooms
