// Answers what people and requests ask about the surface of a room: samples it on the device, in one dispatch for all,
// and hands the answers over when they have come back.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <spindrift/rooms/query_book.h>
#include <spindrift/rooms/room_data.h>

namespace spindrift::rooms {

class RoomQueries {
 public:
  explicit RoomQueries(RoomData& room) : room_(room) {}

  /// Begins the answers of these queries with the present state. Without queries it does nothing; without a free slot
  /// they wait.
  void sample(QueryBook::Which which);
  /// Passes on the answers that have come back.
  void handOver();
  /// Returns whether answers are on their way from the device.
  [[nodiscard]] bool isWaiting() const { return !batches_.empty(); }

  /// Ends the queries of sessions that have left.
  void removeOfGone();
  /// Other water: queries continue in the same water at another resolution, and end in another scene.
  void waterChanged(bool continues);
  /// Ends what waits and streams, and tells the senders why in one line.
  void endAll(const std::string& why);

 private:
  /// The queries that were sampled together, and when.
  struct Batch {
    std::uint64_t number = 0;
    std::uint64_t tick = 0;
    double time_s = 0.0;
    std::uint64_t state_id = 0;
    std::vector<QueryBook::Taken> taken{};
  };
  void answer(const Batch& batch, const sim::SurfaceSamples& samples);

  RoomData& room_;
  std::deque<Batch> batches_;  ///< oldest first; bounded by the slots of the device
  std::uint64_t last_number_ = 0;
};

}  // namespace spindrift::rooms
