// Turns a room's frames into the messages of the channels. No network and no file: both send what comes out of here.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/foxglove/channels.h>

namespace spindrift::foxglove {

struct Message {
  Topic topic{};
  std::uint64_t time_ns = 0;  ///< simulation time, which is also in the message if it has a timestamp
  std::string bytes;          ///< serialized
};

/// Returns a simulation time in nanoseconds; 0 for one below 0.
std::uint64_t nanoseconds(double time_s);

/// Converts the frames of one room. Each message can be read without the others: any of them may be lost.
class Converter {
 public:
  /// Takes the sizes of the room's boats, which a greeting contains as well. A boat whose size has not come is not
  /// drawn, its transform is sent.
  void take(const v1::BoatList& boats);

  /// Returns the messages of the `wanted` topics that are made of the frame, in the order of Topic. The frame's layer
  /// is plain; a packed one can only be passed on (kSurfaceLayer, ...). Error kInvalidInput: a wanted topic needs the
  /// samples of a frame that is packed or damaged.
  [[nodiscard]] core::Result<std::vector<Message>> convert(const v1::LayerFrame& frame, TopicSet wanted) const;

  /// Returns the messages of the `wanted` topics: the diagnostics, and the readings of gauges that have measured.
  [[nodiscard]] std::vector<Message> convert(const v1::Diagnostics& diagnostics, TopicSet wanted) const;

 private:
  std::map<std::uint32_t, std::array<double, 3>> boat_sizes_m_;  ///< by boat_id: length, beam, height
};

}  // namespace spindrift::foxglove
