#include "request_route.h"

#include <utility>
#include <vector>

#include <spindrift/wire/api_message.h>

namespace spindrift::cluster {

net::HttpReply problem(unsigned status, std::string line) {
  v1::Problem out;
  out.set_message(std::move(line));
  return {.status = status, .content_type = "application/json", .body = wire::toJson(out) + "\n"};
}

net::HttpReply tryAgain(std::string line) {
  net::HttpReply out = problem(503, std::move(line));
  out.headers.emplace_back("Retry-After", "1");
  return out;
}

RequestRoute routeOf(const net::HttpRequest& request, const RouteKnowledge& known, Clock::time_point now) {
  const std::string_view rest = std::string_view(request.path).substr(kApi.size());
  if (rest == "rooms" && request.method == "GET") return AskAll{};
  std::string target;
  if (rest.starts_with("rooms/")) {
    const std::string_view named = rest.substr(std::string_view("rooms/").size());
    const std::string room(named.substr(0, named.find('/')));
    if (known.is_server && known.runs(room)) return Here{};
    target = known.servers.serverOf(room);
    if (!target.empty() && !known.servers.isAlive(target, now))
      return tryAgain("the server of room '" + room + "' has failed; the room starts elsewhere: try again");
    if (target.empty() && !known.has_heard_all) return tryAgain(kNotHeardAll);
  } else {
    // Any server can answer; a new room goes to the least loaded one.
    if (known.is_server && rest != "rooms") return Here{};
    target = known.servers.choose(now);
  }
  if (target == known.self || (target.empty() && known.is_server)) return Here{};
  if (target.empty() && rest != "rooms") {
    const std::vector<std::string> alive = known.servers.alive(now);
    if (!alive.empty()) target = alive.front();  // it answers that the room does not exist
  }
  if (target.empty())
    return problem(503, "every server of the cluster has reached its limit of rooms: close one, or add a server");
  return Ask{std::move(target)};
}

}  // namespace spindrift::cluster
