// Commands that Foxglove's clients may send, as services.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <spindrift/wire/client_message.h>

namespace spindrift::foxglove::live {

struct Service {
  std::uint32_t id = 0;
  std::string_view name;       ///< "/splash"
  std::string_view field;      ///< of v1::Command
  std::string request_name;    ///< full name of that field's message
  std::string request_schema;  ///< JSON Schema of its JSON
};

/// JSON Schema of every response.
inline constexpr const char* kResponseSchema =
    R"({"type":"object","properties":{"applied_tick":{"type":"integer"}},"required":["applied_tick"]})";

std::span<const Service> allServices();

/// Returns the command of a request in JSON, checked as one from any client. The error is one line for people.
core::Result<v1::Command> commandOf(const Service& service, std::string_view request);

}  // namespace spindrift::foxglove::live
