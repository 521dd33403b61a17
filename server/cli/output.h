// Writes a command's JSON to a file, or to standard output for "-".
#pragma once

#include <string>

#include <boost/json/value.hpp>

#include <spindrift/core/result.h>

namespace spindrift::cli {

/// Does nothing for an empty name. kUnavailable when the file cannot be written; the message names the option.
core::Result<void> writeJson(const std::string& file, const boost::json::value& value,
                             const std::string& option = "--json");

}  // namespace spindrift::cli
