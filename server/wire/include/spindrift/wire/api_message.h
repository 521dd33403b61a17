// The messages of the REST interface (api.proto) as Protobuf JSON. No text makes any of these functions throw.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include <google/protobuf/message.h>

#include <spindrift/core/command.h>
#include <spindrift/core/result.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::wire {

/// Names as in the proto files, every field written, one line without its end. 64-bit integers are strings, as Protobuf
/// JSON wants them.
std::string toJson(const google::protobuf::Message& message);

/// One Command, names as in the proto files or in lowerCamelCase, checked like one that came over the wire; Malformed
/// for text that is no such object, fields that do not exist included.
std::variant<core::Command, CommandRejection, Malformed> parseCommandJson(std::string_view json);

/// kInvalidInput with one line; names and scene are not checked against what there is.
core::Result<v1::CreateRoom> parseCreateRoomJson(std::string_view json);

}  // namespace spindrift::wire
