// What people and requests ask about the surface of a room: one answer, or a stream of answers. No water, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <spindrift/core/sender.h>
#include <spindrift/sim/surface_sample.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// Limits of what waits and streams: of one session, in addition to wire::kQueryMaxPoints, and of the room.
inline constexpr std::size_t kSessionMaxQueries = 16;
inline constexpr std::size_t kRoomMaxQueryPoints = sim::kMaxSurfacePoints;

/// A query of a room.
struct SurfaceQuery {
  core::Sender sender{};
  v1::Query asked{};
  std::uint64_t begin_tick = 0;                  ///< of the room: its points were then where `asked` says
  std::optional<std::uint64_t> answered_tick{};  ///< of the newest answer that was begun

  [[nodiscard]] bool isStream() const { return asked.interval_ticks() > 0; }
  [[nodiscard]] std::size_t pointCount() const { return static_cast<std::size_t>(asked.x_m_size()); }
  /// Appends its points as they are at this tick.
  void placePoints(std::uint64_t tick, double tick_s, std::vector<sim::SurfacePoint>& out) const;
};

class QueryBook {
 public:
  /// Enters a query that wire::checkCommand() has accepted, at this tick of the room. A stream takes the place of the
  /// one of the same session and id; without points it ends. A rejection names the limit that is reached, and changes
  /// nothing.
  std::optional<wire::CommandRejection> enter(const core::Sender& sender, const v1::Query& asked, std::uint64_t tick);

  enum class Which {
    kNew,  ///< those that have had no answer yet
    kDue   ///< those and the streams whose interval has passed
  };
  /// Returns the points at this tick of the queries to answer now, one query after the other, oldest first.
  [[nodiscard]] std::vector<sim::SurfacePoint> points(Which which, std::uint64_t tick, double tick_s) const;
  /// Takes the same queries: streams stay in the book, and what is returned of them has no points.
  struct Taken {
    SurfaceQuery query;
    std::size_t point_count = 0;
  };
  [[nodiscard]] std::vector<Taken> take(Which which, std::uint64_t tick);
  /// Enters single queries again whose answer was lost. Streams among them are left out.
  void putBack(std::vector<Taken> taken);

  /// Removes the queries for which `holds` returns true, and returns them.
  std::vector<SurfaceQuery> removeIf(const std::function<bool(const SurfaceQuery&)>& holds);
  [[nodiscard]] bool isEmpty() const { return queries_.empty(); }

 private:
  std::vector<SurfaceQuery> queries_;  ///< oldest first, within the limits
};

}  // namespace spindrift::rooms
