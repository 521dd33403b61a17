// JSON texts that grant rights. Private to this module.
#pragma once

#include <string_view>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>

namespace spindrift::access {

/// Parses a JSON object. kInvalidInput, to follow "it" or "they": not a JSON object, nested too deep, or a name that
/// occurs twice in one object: RFC 7515, 7517 and 7519 (sections 4) let a reader refuse those, and two readers could
/// otherwise understand one text differently.
core::Result<boost::json::object> parseJsonObject(std::string_view text);

}  // namespace spindrift::access
