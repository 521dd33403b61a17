// HTTP requests that another server of the cluster answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/access/grant.h>
#include <spindrift/bus/bus.h>
#include <spindrift/cluster/node.h>
#include <spindrift/net/server.h>
#include <spindrift/service/access_control.h>
#include <spindrift/v1/cluster.pb.h>

#include "subjects.h"

namespace spindrift::cluster {

/// Thread-safe.
class Requests {
 public:
  using Clock = std::chrono::steady_clock;

  Requests(bus::Bus& bus, const Subjects& subjects, std::string node)
      : bus_(bus), subjects_(subjects), node_(std::move(node)) {}

  /// Rights of the client; nullopt: the asked server decides.
  using Grant = std::optional<access::Grant>;

  /// Asks one server; 504 if it does not answer.
  void ask(const std::string& server, const net::HttpRequest& request, const Grant& grant, net::HttpResponder respond);
  /// Asks several and joins their lists of rooms. `own`: the list of this process, or empty. Servers that do not answer
  /// are left out.
  void askForRooms(const std::vector<std::string>& servers, const net::HttpRequest& request, const Grant& grant,
                   std::string own, const net::HttpResponder& respond);
  void take(const v1::HttpAnswer& answer);
  /// Answers what waited too long.
  void review(Clock::time_point now);

 private:
  using Taken = std::function<void(const v1::HttpAnswer*)>;  ///< null: no answer came
  struct Waiting {
    Taken taken;
    Clock::time_point until{};
  };
  void send(const std::string& server, const net::HttpRequest& request, const Grant& grant,
            std::chrono::milliseconds patience, Taken taken);

  bus::Bus& bus_;
  const Subjects& subjects_;
  const std::string node_;
  std::mutex mutex_;
  std::uint64_t last_request_ = 0;
  std::map<std::uint64_t, Waiting> waiting_;  ///< at most one per connection
};

/// Returns what the client of a request that goes to another server may. Nullopt: the request was refused.
std::optional<Requests::Grant> admit(service::AccessControl& access, const net::HttpRequest& request,
                                     const net::HttpResponder& respond);
/// Sends the answer of this server to the node that passed the request on.
void answerForward(bus::Bus& bus, const Subjects& subjects, const v1::HttpForward& request, const Node::Answer& answer);

}  // namespace spindrift::cluster
