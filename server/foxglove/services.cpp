#include "services.h"

#include <vector>

#include <boost/json.hpp>
#include <google/protobuf/descriptor.h>

#include <spindrift/core/result.h>
#include <spindrift/wire/api_message.h>

#include "live_messages.h"

namespace spindrift::foxglove::live {
namespace {

namespace json = boost::json;

/// Returns the JSON Schema of a message whose fields are numbers.
std::string schemaOf(const google::protobuf::Descriptor& message) {
  json::object properties;
  for (int i = 0; i < message.field_count(); ++i) properties[message.field(i)->name()] = {{"type", "number"}};
  return json::serialize(
      json::object{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}});
}

std::vector<Service> makeServices() {
  std::vector<Service> out;
  for (const std::string_view field : {"splash", "reset"}) {
    const auto* const request = v1::Command::descriptor()->FindFieldByName(std::string(field))->message_type();
    out.push_back({.id = static_cast<std::uint32_t>(out.size()) + 1,
                   .name = field == "splash" ? "/splash" : "/reset",
                   .field = field,
                   .request_name = request->full_name(),
                   .request_schema = schemaOf(*request)});
  }
  return out;
}

}  // namespace

std::span<const Service> allServices() {
  static const std::vector<Service> services = makeServices();
  return services;
}

core::Result<v1::Command> commandOf(const Service& service, std::string_view request) {
  if (request.empty()) request = "{}";
  boost::system::error_code error;
  json::parse_options options;
  options.max_depth = kJsonMaxDepth;
  const json::value parsed = json::parse(json::string_view(request.data(), request.size()), error, {}, options);
  if (error || !parsed.is_object()) {
    return core::invalid("the request is not a JSON object" + (error ? ": " + error.message() : std::string()));
  }
  std::string command = "{\"";
  command.append(service.field).append("\":").append(request).append("}");
  auto checked = wire::parseCommandJson(command);
  if (!checked) return checked.error();
  if (const auto* rejection = std::get_if<wire::CommandRejection>(&*checked)) {
    return core::invalid((rejection->field().empty() ? "" : rejection->field() + ": ") + rejection->message());
  }
  return std::get<v1::Command>(*std::move(checked));
}

}  // namespace spindrift::foxglove::live
