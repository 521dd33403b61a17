// Checks a JSON text against a message type before Protobuf parses it. Protobuf accepts single quotes, trailing commas
// and more that RFC 8259 forbids, and its errors name internals of the library.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>

namespace spindrift::wire {

/// Maximum nesting; messages of the wire nest 4 deep.
inline constexpr std::size_t kJsonMaxDepth = 32;

/// Returns nullopt if `json` is one JSON object (RFC 8259, UTF-8, at most kJsonMaxDepth deep) whose members are fields
/// of `type` in either spelling, with values of the right kind (object, array, string, number, boolean; numbers may be
/// quoted). Otherwise returns one line: the location or field, what is wrong, what is expected. Does not check ranges
/// of numbers and names of enum values.
std::optional<std::string> checkJson(std::string_view json, const google::protobuf::Descriptor& type);

}  // namespace spindrift::wire
