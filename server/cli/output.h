// Writes a command's JSON to a file, or to standard output for "-".
#pragma once

#include <string>

#include <boost/json/value.hpp>

#include <spindrift/core/result.h>

namespace spindrift::cli {

/// Does nothing for an empty name. kUnavailable when the file cannot be written.
core::Result<void> writeJson(const std::string& file, const boost::json::value& value);

}  // namespace spindrift::cli
