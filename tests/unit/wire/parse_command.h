// Commands as a client sends them, through the parser of the server.
#pragma once

#include <functional>
#include <variant>

#include <gtest/gtest.h>

#include <spindrift/core/bytes.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {

inline ClientMessage parse(const v1::ClientMessage& message) {
  return parseClientMessage(core::viewOf(message.SerializeAsString()));
}

inline v1::ClientMessage commandMessage(const std::function<void(v1::Command&)>& fill) {
  v1::ClientMessage message;
  message.mutable_command()->set_command_id(42);
  fill(*message.mutable_command());
  return message;
}

inline ClientMessage parseCommand(const std::function<void(v1::Command&)>& fill) {
  return parse(commandMessage(fill));
}

inline v1::Command expectCommand(const std::function<void(v1::Command&)>& fill) {
  const ClientMessage message = parseCommand(fill);
  if (const auto* command = std::get_if<v1::Command>(&message)) {
    EXPECT_EQ(command->command_id(), 42u);
    return *command;
  }
  ADD_FAILURE() << "no command";
  return {};
}

}  // namespace spindrift::wire
