#include "cluster_metrics.h"

#include <spindrift/service/metrics.h>

namespace spindrift::cluster {

std::string metricsText(const ClusterCounts& counts) {
  std::string out;
  const auto add = [&out](const char* name, const char* type, const char* help, auto value) {
    out += service::metric(name, type, help, static_cast<double>(value));
  };
  add("nats_connected", "gauge", "1 while there is a connection to NATS.", counts.bus.is_connected);
  add("nats_reconnects_total", "counter", "Times the connection to NATS came back.", counts.bus.reconnect_count);
  add("nats_dropped_messages_total", "counter",
      "Messages lost: not sent while disconnected, or more than a receiver took.", counts.bus.dropped_message_count);
  add("cluster_servers", "gauge", "Servers of the cluster that are alive.", counts.alive_server_count);
  add("cluster_remote_frames_total", "counter", "Frames received from rooms of other servers.",
      counts.links.frame_count);
  add("cluster_remote_gaps_total", "counter", "Times that frames or messages of a room were missing.",
      counts.links.gap_count);
  add("cluster_lost_links_total", "counter", "Times that the server of a room fell silent.",
      counts.links.lost_link_count);
  if (!counts.server) return out;
  add("cluster_published_frames_total", "counter", "Frames published for nodes.", counts.server->feed.frame_count);
  add("cluster_lost_nodes_total", "counter", "Nodes that fell silent while they watched a room.",
      counts.server->feed.lost_link_count);
  add("cluster_rooms_taken_total", "counter", "Rooms taken over from other servers.", counts.server->taken_room_count);
  add("cluster_directory_failures_total", "counter",
      "Rooms that could not be taken over, and failures of the directory of rooms.",
      counts.server->directory_failure_count);
  return out;
}

}  // namespace spindrift::cluster
