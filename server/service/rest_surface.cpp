// The water at points, by requests: each is a query that is answered once.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <spindrift/core/text.h>
#include <spindrift/http/url.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/wire/api_message.h>

#include "rest_replies.h"

namespace spindrift::service {
namespace {

constexpr std::size_t kEchoMaxBytes = 64;

core::Result<float> metresIn(std::string_view query, const std::string& name) {
  const std::string advice = "; give the position in metres, as ?x=1.5&z=-2";
  const auto values = net::queryValues(query, name);
  if (!values || values->size() != 1)
    return core::invalid(name + ": " + (values ? std::to_string(values->size()) : "broken") + " values" + advice);
  const std::string& text = values->front();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    return core::invalid(name + ": '" + core::cleanText(text, kEchoMaxBytes) + "' is not a number" + advice);
  const auto metres = static_cast<float>(value);
  if (!std::isfinite(metres))
    return core::invalid(name + ": " + core::formatNumber(value) + " is not a finite number" + advice);
  return metres;
}

/// Returns the position "x=1.5&z=-2" as a query with one point.
core::Result<v1::Query> queryIn(std::string_view query) {
  for (std::string_view rest = query; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    const std::string_view name = part.substr(0, part.find('='));
    if (name != "x" && name != "z") {
      return core::invalid("'" + core::cleanText(std::string(name), kEchoMaxBytes) +
                           "' is not a parameter of this address; it takes x and z");
    }
  }
  const auto x_m = metresIn(query, "x");
  if (!x_m) return x_m.error();
  const auto z_m = metresIn(query, "z");
  if (!z_m) return z_m.error();
  v1::Query out;
  out.add_x_m(*x_m);
  out.add_z_m(*z_m);
  return out;
}

v1::SurfacePoint pointOf(const v1::Query& query, const v1::QueryAnswer& answer) {
  const v1::QueryResult& result = answer.results(0);
  v1::SurfacePoint out;
  out.set_tick(answer.tick());
  out.set_time_s(answer.time_s());
  out.set_x_m(query.x_m(0));
  out.set_z_m(query.z_m(0));
  out.set_elevation_m(result.elevation_m(0));
  out.set_vertical_speed_mps(result.vertical_speed_mps(0));
  out.set_velocity_x_mps(result.velocity_x_mps(0));
  out.set_velocity_z_mps(result.velocity_z_mps(0));
  out.set_slope_x(result.slope_x(0));
  out.set_slope_z(result.slope_z(0));
  out.set_depth_m(result.depth_m(0));
  out.set_wet_ratio(result.wet_ratio(0));
  out.set_foam_ratio(result.foam_ratio(0));
  out.set_outside(result.outside_size() > 0);
  return out;
}

}  // namespace

void RestApi::surface(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond) {
  if (call.request.method == "GET") {
    const auto query = queryIn(call.request.query);
    if (!query) return respond(problem(400, query.error().message));
    v1::Command command;
    *command.mutable_query() = *query;
    const auto answered = [query = *query](const v1::QueryAnswer& answer) { return json(200, pointOf(query, answer)); };
    return submit(call, room, {std::move(command)}, {.respond = std::move(respond), .answered = answered});
  }
  if (call.request.method != "POST") return respond(wrongMethod("GET, POST"));
  if (!isJson(call.request.content_type)) return respond(bodyIsNotJson());
  const auto answered = [](const v1::QueryAnswer& answer) { return json(200, answer); };
  submit(call, room, wire::parseQueryJson(bodyOf(call.request)), {.respond = std::move(respond), .answered = answered});
}

void RestApi::queryAnswered(const core::Sender& sender, const v1::QueryAnswer& answer) {
  const Pending pending = takePending(sender.request_id);
  if (!pending.respond) return;
  const std::string& ended = answer.results(0).ended();
  pending.respond(ended.empty() ? pending.answered(answer) : problem(503, ended + ": ask again"));
}

}  // namespace spindrift::service
