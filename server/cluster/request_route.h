// Which server of the cluster answers a request to the REST interface. A pure decision.
#pragma once

#include <functional>
#include <string>
#include <variant>

#include <spindrift/net/server.h>

#include "placement.h"

namespace spindrift::cluster {

struct Here {};    ///< this process
struct AskAll {};  ///< this process and all servers, whose lists of rooms are joined
struct Ask {
  std::string server;
};
/// A reply: no server can answer.
using RequestRoute = std::variant<Here, AskAll, Ask, net::HttpReply>;

/// Facts that routeOf() decides by.
struct RouteKnowledge {
  const Servers& servers;
  const std::string& self;
  bool is_server = false;                             ///< it runs rooms
  bool has_heard_all = false;                         ///< a room that no server runs does not exist
  std::function<bool(const std::string& room)> runs;  ///< whether the room runs here
};

/// Paths of the REST interface begin with this.
inline constexpr std::string_view kApi = "/api/v1/";

inline constexpr const char* kNotHeardAll = "not all servers of the cluster were heard yet: try again";

/// Returns a reply with a v1::Problem as JSON.
net::HttpReply problem(unsigned status, std::string line);
/// Returns 503 with Retry-After.
net::HttpReply tryAgain(std::string line);

/// Returns who answers a request whose path begins with kApi.
RequestRoute routeOf(const net::HttpRequest& request, const RouteKnowledge& known, Clock::time_point now);

}  // namespace spindrift::cluster
