// The REST interface: rooms, their scenes and parameters, commands, health. Runs on I/O threads; the outcomes of
// commands come from the rooms' threads.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <spindrift/net/server.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/access_control.h>
#include <spindrift/service/cluster_hooks.h>
#include <spindrift/service/ground_answers.h>
#include <spindrift/service/metrics.h>
#include <spindrift/service/recordings.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::service {

/// Returns the HTTP status for a rejected command.
unsigned httpStatusOf(v1::RejectReason reason);

class RestApi {
 public:
  /// All references must outlive it. `dismiss`: closes a room's sessions before the room closes. `on_drain`: ends the
  /// server, called once; empty: refused.
  RestApi(AccessControl& access, CommandCounters& counters, const MetricsSources& sources, Recordings& recordings,
          std::function<void(const rooms::Room&)> dismiss, std::function<void()> on_drain);

  /// Sets the rooms; call it before the network starts.
  void serve(rooms::RoomHost& rooms) { rooms_ = &rooms; }
  /// Makes the server part of a cluster; call it before the network starts.
  void join(const ClusterHooks& cluster) { cluster_ = cluster; }
  /// Sets what GET /api/v1/join answers; call it before the network starts.
  void tellPadUrls(std::function<std::vector<std::string>()> pad_urls) { pad_urls_ = std::move(pad_urls); }
  /// Makes /readyz answer 503 from now on, and opens no more rooms. Thread-safe.
  void drain() { is_draining_ = true; }
  /// Answers any request that net passes to the application. `decided`: what the client may, where the process to which
  /// it is connected has decided that.
  void answer(const net::HttpRequest& request, net::HttpResponder respond,
              const std::optional<access::Grant>& decided = std::nullopt);

  /// Reports the outcome of a request's command, by its request_id. A rejection is counted and entered into the audit
  /// log.
  void commandApplied(const rooms::Command& command, const v1::Ack& ack);
  void commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection);
  /// Reports the answer to a request's query, by its request_id; commandApplied() came before.
  void queryAnswered(const core::Sender& sender, const v1::QueryAnswer& answer);

 private:
  /// A request whose outcome comes from its room.
  struct Pending {
    net::HttpResponder respond{};
    std::function<net::HttpReply(const v1::QueryAnswer&)> answered{};  ///< makes the reply to a query
  };
  struct Call {
    const net::HttpRequest& request;
    std::vector<std::string> path;  ///< after /api/v1/: {"rooms", "main", "commands"}
    access::Grant grant;

    [[nodiscard]] bool isOperator() const { return grant.role >= core::Role::kOperator; }
    /// Returns the details for the audit log.
    [[nodiscard]] core::SenderDetails details(const std::string& room) const {
      return {.room = room, .subject = grant.subject, .name = "", .peer = request.peer};
    }
  };

  void rooms(const Call& call, net::HttpResponder respond);
  void createRoom(const Call& call, net::HttpResponder respond);
  void room(const Call& call, net::HttpResponder respond);
  void drainServer(const Call& call, const net::HttpResponder& respond);
  void closeRoom(const Call& call, net::HttpResponder respond);
  void command(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond);
  using ParsedCommand = core::Result<std::variant<v1::Command, wire::CommandRejection>>;
  /// Sends the command to the room; its outcome answers the request.
  void submit(const Call& call, const std::shared_ptr<rooms::Room>& room, ParsedCommand parsed, Pending pending);
  void surface(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond);
  void snapshot(const Call& call, rooms::Room& room, const net::HttpResponder& respond);
  void recording(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond);
  void stateHash(const Call& call, rooms::Room& room, const net::HttpResponder& respond);
  void gauges(const Call& call, const rooms::Room& room, const net::HttpResponder& respond);
  void fillRoomInfo(const rooms::Room& room, v1::RoomInfo& out) const;
  [[nodiscard]] core::Result<access::Grant> resolve(const std::string& authorization) const;
  Pending takePending(std::uint64_t request_id);

  AccessControl& access_;
  CommandCounters& counters_;
  const MetricsSources& sources_;
  Recordings& recordings_;
  const std::function<void(const rooms::Room&)> dismiss_;
  const std::function<void()> on_drain_;
  std::atomic<bool> is_draining_{false};
  rooms::RoomHost* rooms_ = nullptr;                    ///< set before any request arrives
  ClusterHooks cluster_;                                ///< set before any request arrives
  std::function<std::vector<std::string>()> pad_urls_;  ///< set before any request arrives
  GroundAnswers ground_;
  std::atomic<std::uint64_t> last_request_id_{0};
  std::mutex mutex_;
  std::map<std::uint64_t, Pending> pending_;  ///< at most one per connection
};

}  // namespace spindrift::service
