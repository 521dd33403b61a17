#include <algorithm>
#include <cassert>
#include <cctype>
#include <exception>
#include <utility>

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <spindrift/core/text.h>
#include <spindrift/wire/api_message.h>

#include "json_check.h"

namespace spindrift::wire {
namespace {

constexpr std::size_t kReasonMaxBytes = 200;

/// Rewords Protobuf's message for a value of the wrong type, `(splash.depth_m): invalid value "deep" for type
/// TYPE_DOUBLE`; other messages stay unchanged.
std::string inOurWords(const std::string& reason) {
  constexpr std::string_view kBegin = "(", kValue = "): invalid value ", kType = " for type ";
  constexpr std::string_view kScalar = "TYPE_", kNamed = "type.googleapis.com/spindrift.v1.";
  const std::size_t value = reason.find(kValue), type = reason.rfind(kType);
  if (!reason.starts_with(kBegin) || value == std::string::npos || type == std::string::npos || type < value) {
    return reason;
  }
  std::string name = reason.substr(type + kType.size());
  if (name.starts_with(kScalar)) {
    name.erase(0, kScalar.size());
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  } else if (name.starts_with(kNamed)) {
    name.erase(0, kNamed.size());
  }
  const std::size_t value_begin = value + kValue.size();
  return reason.substr(kBegin.size(), value - kBegin.size()) + ": " + reason.substr(value_begin, type - value_begin) +
         " is not of type " + name;
}

/// Returns an empty string, or the reason why the text is not such a message.
std::string readJson(std::string_view json, google::protobuf::Message& out) {
  const std::string what = "the body is not JSON of spindrift.v1." + out.GetDescriptor()->name() + ": ";
  if (const auto why = checkJson(json, *out.GetDescriptor())) return what + *why;
  try {
    const google::protobuf::LogSilencer silencer;
    const auto status =
        google::protobuf::util::JsonStringToMessage(google::protobuf::StringPiece(json.data(), json.size()), &out);
    if (status.ok()) return "";
    const auto reason = status.message();
    const std::string line(reason.data(), reason.size());
    // After its first line Protobuf's error quotes the text.
    return what + core::cleanText(inOurWords(line.substr(0, line.find('\n'))), kReasonMaxBytes);
  } catch (const std::exception& error) {
    return std::string("the body could not be read: ") + error.what();
  }
}

template <typename Message>
core::Result<Message> parse(std::string_view json) {
  Message out;
  if (std::string why = readJson(json, out); !why.empty()) return core::invalid(std::move(why));
  return out;
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

core::Result<std::variant<v1::Command, CommandRejection>> parseCommandJson(std::string_view json) {
  auto command = parse<v1::Command>(json);
  if (!command) return command.error();
  return checkCommand(*std::move(command));
}

core::Result<std::variant<v1::Command, CommandRejection>> parseQueryJson(std::string_view json) {
  using Parsed = std::variant<v1::Command, CommandRejection>;
  auto query = parse<v1::Query>(json);
  if (!query) return query.error();
  if (query->x_m().empty()) {
    return Parsed(rejection(v1::REJECT_REASON_OUT_OF_RANGE, "query.x_m", "there are no points; give at least one"));
  }
  if (query->interval_ticks() > 0) {
    return Parsed(rejection(v1::REJECT_REASON_OUT_OF_RANGE, "query.interval_ticks",
                            "a request is answered once; leave it out, or ask over a WebSocket"));
  }
  v1::Command command;
  *command.mutable_query() = *std::move(query);
  return checkCommand(std::move(command));
}

core::Result<v1::CreateRoom> parseCreateRoomJson(std::string_view json) {
  return parse<v1::CreateRoom>(json);
}

core::Result<v1::StartRecording> parseStartRecordingJson(std::string_view json) {
  return parse<v1::StartRecording>(json);
}

core::Result<v1::RoomList> parseRoomListJson(std::string_view json) {
  return parse<v1::RoomList>(json);
}

}  // namespace spindrift::wire
