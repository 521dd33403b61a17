// This process as a part of a cluster of servers and edges that talk over NATS. A server runs rooms and says which; an
// edge runs none. Both serve sessions of any room of the cluster. docs/cluster.md describes what happens when a part
// fails.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/cluster_hooks.h>
#include <spindrift/service/sessions.h>

namespace spindrift::cluster {

struct NodeOptions {
  std::string nats_url;
  std::string ca_file;                ///< certificates that sign the NATS server's; empty: the system's
  std::string cluster = "spindrift";  ///< letters, digits, '_', '-': begins all subjects
  std::string name;                   ///< of this process, unique in the cluster, as core::isRoomName()
  bool runs_rooms = false;            ///< a server, not an edge
  std::size_t room_max_count = 0;     ///< of a server
  /// Another process has the name, which was cut off when this one started, or the other way round: this one has to
  /// end. Called on a thread of the node; empty: only logged.
  std::function<void()> on_name_lost{};
};

class Node : public service::Cluster {
 public:
  /// Connects to NATS and, for a server, opens the directory of rooms; blocks for about a second, in which the others
  /// are heard. Errors: kInvalidInput for a name that is malformed or that another process has, kUnavailable when NATS
  /// does not answer or lacks JetStream.
  static core::Result<std::unique_ptr<Node>> connect(const NodeOptions& options);

  /// Takes those of the rooms that no other server runs. Before WaterServer::start(). Error kUnavailable when the
  /// directory does not answer.
  virtual core::Result<std::vector<rooms::RoomSetup>> claim(std::vector<rooms::RoomSetup> rooms) = 0;
  [[nodiscard]] virtual service::ClusterHooks hooks() = 0;

  /// See RestApi::answer().
  using Answer = std::function<void(const net::HttpRequest&, net::HttpResponder, const std::optional<access::Grant>&)>;
  /// Parts that a server has and an edge has not.
  struct ServerParts {
    rooms::RoomHost* simulation = nullptr;
    rooms::RoomOutlets* outlets = nullptr;  ///< of the rooms
    Answer answer{};                        ///< to requests
  };
  /// Starts the work. `sessions` and the parts outlive the node.
  virtual void serve(service::Sessions& sessions, const ServerParts& server) = 0;
  /// Returns success when rooms of other servers can be served: NATS is connected and, for an edge, a server is alive.
  /// kUnavailable says in one line why not.
  [[nodiscard]] virtual core::Result<void> ready() const = 0;
  /// Takes no rooms any more. The rooms continue.
  virtual void leave() = 0;
  /// Lets others take the rooms at once. Call it when they have ended and their state is saved.
  virtual void release() = 0;
};

}  // namespace spindrift::cluster
