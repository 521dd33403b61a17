// Many clients on servers that run already: what each of them receives, how late, and how long it is without frames.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <boost/json/object.hpp>

#include <spindrift/core/level.h>
#include <spindrift/core/result.h>

namespace spindrift::bench {

struct LoadOptions {
  std::vector<std::string> urls;  ///< "ws://HOST:PORT/ws/ROOM"; clients are spread over them
  std::size_t client_count = 100;
  core::Level level = core::Level::kCoarse;
  double seconds = 10.0;
  double commands_per_s = 0.1;  ///< splashes of each client
  std::string token;
};

/// Connects the clients over a few seconds and measures for `seconds`. A client whose connection ends continues at the
/// next URL, with its resume key. Delays compare the time in frames with the clock of this machine: they have a meaning
/// on the machine of the simulation only. Prints a table. Errors: kInvalidInput for a URL; kUnavailable if no client
/// received a frame.
core::Result<boost::json::object> measureLoad(const LoadOptions& options, std::FILE* out);

}  // namespace spindrift::bench
