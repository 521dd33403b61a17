#include <cassert>
#include <exception>
#include <utility>

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <spindrift/stream/api_message.h>

#include "text.h"

namespace spindrift::stream {
namespace {

constexpr std::size_t kReasonMaxBytes = 200;

/// Empty, or why the text is no such message.
std::string readJson(std::string_view json, google::protobuf::Message& out) {
  try {
    const google::protobuf::LogSilencer silencer;
    const auto status =
        google::protobuf::util::JsonStringToMessage(google::protobuf::StringPiece(json.data(), json.size()), &out);
    if (status.ok()) return "";
    const auto reason = status.message();
    return "the body is no JSON of spindrift.v1." + out.GetDescriptor()->name() + ": " +
           cleanText(std::string(reason.data(), reason.size()), kReasonMaxBytes);
  } catch (const std::exception& error) {
    return std::string("the body could not be read: ") + error.what();
  }
}

}  // namespace

std::string toJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string out;
  [[maybe_unused]] const auto status = google::protobuf::util::MessageToJsonString(message, &out, options);
  assert(status.ok());
  return out;
}

std::variant<core::Command, CommandRejection, Malformed> parseCommandJson(std::string_view json) {
  v1::Command command;
  if (std::string why = readJson(json, command); !why.empty()) return Malformed{std::move(why)};
  return std::visit(
      [](auto&& checked) -> std::variant<core::Command, CommandRejection, Malformed> { return std::move(checked); },
      checkCommand(command));
}

core::Result<v1::CreateRoom> parseCreateRoomJson(std::string_view json) {
  v1::CreateRoom create;
  if (std::string why = readJson(json, create); !why.empty()) {
    return core::Error{core::ErrorCode::kInvalidInput, std::move(why)};
  }
  return create;
}

}  // namespace spindrift::stream
