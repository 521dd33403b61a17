#include "live_messages.h"

#include <concepts>

#include <boost/json.hpp>

#include "services.h"

namespace spindrift::foxglove::live {
namespace {

namespace json = boost::json;

/// First byte of a binary message.
enum class Opcode : std::uint8_t { kData = 1, kTime = 2, kServiceResponse = 3 };

Outgoing text(const json::object& message) {
  const std::string line = json::serialize(message);
  return {core::share(core::Bytes(line.begin(), line.end())), true};
}

/// A binary message under construction.
class Binary {
 public:
  Binary(Opcode opcode, std::size_t bytes_count) {
    bytes_.reserve(1 + bytes_count);
    bytes_.push_back(static_cast<std::uint8_t>(opcode));
  }
  template <std::unsigned_integral Number>
  Binary& add(Number number) {
    for (std::size_t k = 0; k < sizeof(Number); ++k) bytes_.push_back(static_cast<std::uint8_t>(number >> (8 * k)));
    return *this;
  }
  Binary& add(std::string_view part) {
    bytes_.insert(bytes_.end(), part.begin(), part.end());
    return *this;
  }
  Outgoing take() { return {core::share(std::move(bytes_)), false}; }

 private:
  core::Bytes bytes_;
};

/// RFC 4648 section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out.push_back(i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=');
  }
  return out;
}

json::array idsOf(TopicSet topics) {
  json::array out;
  for (const Channel& channel : allChannels())
    if (topics[static_cast<std::size_t>(channel.topic)]) out.emplace_back(channel.id());
  return out;
}

}  // namespace

Outgoing serverInfo(const v1::Greeting& greeting) {
  return text({{"op", "serverInfo"},
               {"name", greeting.server() + ", room " + greeting.room()},
               {"capabilities", {"time", "parameters", "parametersSubscribe", "services"}},
               {"supportedEncodings", {"json"}},
               {"metadata", {{"room", greeting.room()}, {"device", greeting.device()}}},
               {"sessionId", std::to_string(greeting.session_id())}});
}

Outgoing advertise(TopicSet topics) {
  json::array channels;
  for (const Channel& channel : allChannels()) {
    if (!topics[static_cast<std::size_t>(channel.topic)]) continue;
    channels.push_back({{"id", channel.id()},
                        {"topic", channel.name},
                        {"encoding", kEncoding},
                        {"schemaName", channel.schema_name},
                        {"schemaEncoding", kEncoding},
                        {"schema", base64(channel.schema)}});
  }
  return text({{"op", "advertise"}, {"channels", std::move(channels)}});
}

Outgoing unadvertise(TopicSet topics) {
  return text({{"op", "unadvertise"}, {"channelIds", idsOf(topics)}});
}

Outgoing advertiseServices() {
  json::array services;
  for (const Service& service : allServices()) {
    const auto schema = [](std::string_view name, const std::string& text) {
      return json::object{
          {"encoding", "json"}, {"schemaName", name}, {"schemaEncoding", "jsonschema"}, {"schema", text}};
    };
    services.push_back({{"id", service.id},
                        {"name", service.name},
                        {"type", service.request_name},
                        {"request", schema(service.request_name, service.request_schema)},
                        {"response", schema("Applied", kResponseSchema)}});
  }
  return text({{"op", "advertiseServices"}, {"services", std::move(services)}});
}

Outgoing status(StatusLevel level, std::string_view line) {
  return text({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", line}});
}

Outgoing parameterValues(const std::vector<std::pair<std::string, double>>& values,
                         const std::optional<std::string>& id) {
  json::array parameters;
  for (const auto& [name, value] : values)
    parameters.push_back({{"name", name}, {"value", value}, {"type", "float64"}});
  json::object message{{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
  if (id) message["id"] = *id;
  return text(message);
}

Outgoing serviceFailure(std::uint32_t service_id, std::uint32_t call_id, std::string_view why) {
  return text({{"op", "serviceCallFailure"}, {"serviceId", service_id}, {"callId", call_id}, {"message", why}});
}

Outgoing serviceResponse(std::uint32_t service_id, std::uint32_t call_id, std::string_view response) {
  constexpr std::string_view kJson = "json";
  return Binary(Opcode::kServiceResponse, 3 * sizeof(std::uint32_t) + kJson.size() + response.size())
      .add(service_id)
      .add(call_id)
      .add(static_cast<std::uint32_t>(kJson.size()))
      .add(kJson)
      .add(response)
      .take();
}

Outgoing data(std::uint32_t subscription_id, const Message& message) {
  return Binary(Opcode::kData, sizeof(std::uint32_t) + sizeof(std::uint64_t) + message.bytes.size())
      .add(subscription_id)
      .add(message.time_ns)
      .add(message.bytes)
      .take();
}

Outgoing time(std::uint64_t time_ns) {
  return Binary(Opcode::kTime, sizeof(time_ns)).add(time_ns).take();
}

}  // namespace spindrift::foxglove::live
