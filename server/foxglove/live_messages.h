// Messages of Foxglove's WebSocket protocol that the server sends.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spindrift/core/translator.h>
#include <spindrift/foxglove/converter.h>

namespace spindrift::foxglove::live {

using Outgoing = core::Translator::Outgoing;

/// Limit of JSON from clients.
inline constexpr std::size_t kJsonMaxDepth = 16;

enum class StatusLevel : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };

Outgoing serverInfo(const v1::Greeting& greeting);
Outgoing advertise(TopicSet topics);
Outgoing unadvertise(TopicSet topics);
/// Announces all of allServices().
Outgoing advertiseServices();
/// `text`: one line for people.
Outgoing status(StatusLevel level, std::string_view text);
/// `id`: of the request that it answers.
Outgoing parameterValues(const std::vector<std::pair<std::string, double>>& values,
                         const std::optional<std::string>& id);
Outgoing serviceFailure(std::uint32_t service_id, std::uint32_t call_id, std::string_view why);
/// `json`: the response.
Outgoing serviceResponse(std::uint32_t service_id, std::uint32_t call_id, std::string_view json);
Outgoing data(std::uint32_t subscription_id, const Message& message);
Outgoing time(std::uint64_t time_ns);

}  // namespace spindrift::foxglove::live
