// The log of the program, on standard error: standard output is for results (--json -, the address of the server).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <spdlog/formatter.h>

namespace spindrift::cli {

struct LogOptions {
  std::string level = "info";
  std::string format = "text";  ///< text or json
};

/// Adds --log-level and --log-format.
void addLogOptions(CLI::App& program, LogOptions& options);

/// {"time":"2026-01-31T12:00:00.123Z","level":"info","thread":4711,"message":"room main: …"}. The time is RFC 3339 in
/// UTC. Every line is valid JSON in UTF-8, whatever the message holds: bytes that are not UTF-8 become U+FFFD, and line
/// breaks are escaped.
class JsonLogFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override;
  std::unique_ptr<spdlog::formatter> clone() const override;
};

/// Returns the text without control characters, its lines after the first one indented by four spaces.
std::string indentLines(std::string_view text);

/// Sets the name in failures and in the log; "spindrift" if it is not called. Call it before other threads start.
void nameProgram(const std::string& name);

/// Makes spdlog's default logger. Call once, before other threads start.
void setUpLogging(const LogOptions& options);

/// Writes a failure that ends the program: "PROGRAM: MESSAGE", or a JSON object once setUpLogging() chose JSON.
void reportFailure(const std::string& message);

}  // namespace spindrift::cli
