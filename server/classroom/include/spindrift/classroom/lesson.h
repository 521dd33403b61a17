// What a lesson allows to players. Pure functions; Roster keeps the lesson of a room.
#pragma once

#include <optional>

#include <spindrift/core/sender.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// Returns the tool that a command works with; TOOL_UNSPECIFIED for the commands of operators.
[[nodiscard]] v1::Tool toolOf(const v1::Command& command);

/// Returns why the lesson does not take a command of somebody with this role now; nullopt if it does. Operators are
/// free of it.
[[nodiscard]] std::optional<wire::CommandRejection> refuse(const v1::Lesson& lesson, bool is_muted, core::Role role,
                                                           const v1::Command& command);

/// Reduces what a command does to the water to this share of it: depths, heights, speeds of throws, pressures of
/// fingers, throttles. Stays within the ranges of the fields. The command is completed.
void limitForce(double force_ratio, v1::Command& command);

}  // namespace spindrift::rooms
