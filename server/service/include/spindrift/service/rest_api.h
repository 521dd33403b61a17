// The REST interface: rooms, their scenes and parameters, commands from afar, health. Runs on I/O threads; what became
// of a command comes from the simulation thread.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/net/server.h>
#include <spindrift/rooms/simulation_thread.h>
#include <spindrift/service/access.h>
#include <spindrift/service/metrics.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::service {

/// The HTTP status that a rejected command gets.
unsigned httpStatusOf(v1::RejectReason reason);

class RestApi {
 public:
  /// Everything given outlives it. `dismiss` sends a room's sessions away before it closes.
  RestApi(const Access& access, CommandCounters& counters, const MetricsSources& sources,
          std::function<void(const rooms::Room&)> dismiss);

  /// Before the network starts.
  void serve(rooms::SimulationThread& rooms) { rooms_ = &rooms; }
  void serverStarts(net::Hub& hub) { hub_ = &hub; }
  /// Any request that net leaves to the application.
  void answer(const net::HttpRequest& request, net::HttpResponder respond);

  /// The commands of requests, by their request_id.
  void commandApplied(const core::Command& command, std::uint64_t tick, std::uint32_t boat_id);
  void commandRejected(const core::Command& command, const wire::CommandRejection& rejection);

 private:
  struct Call {
    const net::HttpRequest& request;
    std::vector<std::string> path;  ///< after /api/v1/: {"rooms", "main", "commands"}
    core::Role role = core::Role::kViewer;
  };

  void rooms(const Call& call, net::HttpResponder respond);
  void createRoom(const Call& call, net::HttpResponder respond);
  void room(const Call& call, net::HttpResponder respond);
  void closeRoom(const Call& call, net::HttpResponder respond);
  void command(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond);
  void fillRoomInfo(const rooms::Room& room, v1::RoomInfo& out) const;
  net::HttpResponder takePending(std::uint64_t request_id);

  const Access& access_;
  CommandCounters& counters_;
  const MetricsSources& sources_;
  const std::function<void(const rooms::Room&)> dismiss_;
  rooms::SimulationThread* rooms_ = nullptr;  ///< set before any request comes
  net::Hub* hub_ = nullptr;                   ///< likewise
  std::atomic<std::uint64_t> last_request_id_{0};
  std::mutex mutex_;
  std::map<std::uint64_t, net::HttpResponder> pending_;  ///< bounded by the connections: one request each
};

}  // namespace spindrift::service
