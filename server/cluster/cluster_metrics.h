// What a process of a cluster counts, as Prometheus text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <spindrift/bus/bus.h>

#include "feed.h"
#include "remote_room.h"

namespace spindrift::cluster {

struct ClusterCounts {
  /// Counts of a process that runs rooms.
  struct Server {
    FeedStats feed;
    std::uint64_t taken_room_count = 0;
    std::uint64_t directory_failure_count = 0;
  };
  bus::BusStats bus;
  std::size_t alive_server_count = 0;
  LinkStats links{};  ///< of all links to rooms of other servers, those that ended included
  std::optional<Server> server{};
};

/// Returns one metric after the other; docs/cluster.md explains them.
std::string metricsText(const ClusterCounts& counts);

}  // namespace spindrift::cluster
