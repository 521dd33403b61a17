// Whether a text is JSON of a message, before Protobuf reads it: its JSON reader takes single quotes, trailing commas
// and more that RFC 8259 does not, and its errors are in its own terms.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>

namespace spindrift::wire {

/// Values within values, at most; messages of the wire nest 4 deep.
inline constexpr std::size_t kJsonMaxDepth = 32;

/// nullopt if `json` is one JSON object (RFC 8259, UTF-8, at most kJsonMaxDepth deep) whose members are fields of
/// `type` by either spelling, with values of the right kind (object, array, string, number, boolean; numbers may be
/// quoted). Otherwise one line: where in the text, or which field, what is wrong, what is expected. Not checked:
/// whether numbers and names of enum values fit.
std::optional<std::string> checkJson(std::string_view json, const google::protobuf::Descriptor& type);

}  // namespace spindrift::wire
