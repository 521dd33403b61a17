// Clients that come and go, draw strokes, sail boats and change what they watch, on servers that run already.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>

namespace spindrift::bench {

struct SoakOptions {
  std::vector<std::string>
      urls;  ///< "ws://HOST:PORT/ws/ROOM"; a room that is not there is refused, and that is counted
  std::size_t client_count = 40;
  double seconds = 60.0;
  double warm_up_s = 0.0;             ///< at the start; not part of the result
  double interval_s = 10.0;           ///< a row is printed as often
  double churn_per_s = 1.0;           ///< connections that clients end, all together
  double strokes_per_s = 0.2;         ///< of a finger, of each client, at most one after the other
  double waves_per_s = 0.025;         ///< of each client
  double boats_per_s = 0.02;          ///< of each client: boats launched and removed
  double level_changes_per_s = 0.05;  ///< of each client: another level, rate or packing of a layer
  std::uint32_t seed = 1;
  std::string token;
};

/// Prints a row per interval and a table, and returns the same totals as the table. Every eighth client decodes all of
/// its frames and looks for numbers that are not finite. Errors: kInvalidInput for a URL; kUnavailable if no client
/// received a frame.
core::Result<boost::json::object> measureSoak(const SoakOptions& options, std::FILE* out);

}  // namespace spindrift::bench
