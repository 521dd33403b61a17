// Writes log messages as JSON, one object per line.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <spdlog/formatter.h>

namespace spindrift::cli {

/// {"time":"2026-01-31T12:00:00.123Z","level":"info","thread":4711,"message":"room main: …"}. The time is RFC 3339 in
/// UTC. Every line is valid JSON in UTF-8, whatever the message holds: bytes that are not UTF-8 become U+FFFD, and line
/// breaks are escaped.
class JsonLogFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override;
  std::unique_ptr<spdlog::formatter> clone() const override;
};

/// Returns `text` with U+FFFD in place of each byte that belongs to no UTF-8 sequence.
std::string toValidUtf8(std::string_view text);

}  // namespace spindrift::cli
