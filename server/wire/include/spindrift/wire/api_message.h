// Messages of the REST interface (api.proto) as Protobuf JSON. No input makes these functions throw.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include <google/protobuf/message.h>

#include <spindrift/core/result.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {

/// Returns one line without line end, with the proto files' names and every field. 64-bit integers are strings, as
/// Protobuf JSON requires.
std::string toJson(const google::protobuf::Message& message);

/// Parses one Command, with names as in the proto files or in lowerCamelCase, and checks it like one from a session.
/// kInvalidInput with one line for text that is no such object or has unknown fields.
core::Result<std::variant<v1::Command, CommandRejection>> parseCommandJson(std::string_view json);

/// Parses the body of a request for the water at points, a Query, in the same way. It has points, and one answer.
core::Result<std::variant<v1::Command, CommandRejection>> parseQueryJson(std::string_view json);

/// Parses the body of a request for a room. Error: kInvalidInput with one line. Does not check whether the name is free
/// or the scene exists.
core::Result<v1::CreateRoom> parseCreateRoomJson(std::string_view json);

/// Parses the body of a request for a recording. Error: kInvalidInput with one line.
core::Result<v1::StartRecording> parseStartRecordingJson(std::string_view json);

/// Parses a list as toJson() writes it; kInvalidInput with one line.
core::Result<v1::RoomList> parseRoomListJson(std::string_view json);

}  // namespace spindrift::wire
