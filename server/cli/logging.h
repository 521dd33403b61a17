// The log of the program, on standard error: standard output is for results (--json -, the address of the server).
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace spindrift::cli {

struct LogOptions {
  std::string level = "info";
  std::string format = "text";  ///< text or json
};

/// Adds --log-level and --log-format.
void addLogOptions(CLI::App& program, LogOptions& options);

/// Returns the text without control characters, its lines after the first one indented by four spaces.
std::string indentLines(std::string_view text);

/// Sets the name in failures and in the log; "spindrift" if it is not called. Call it before other threads start.
void nameProgram(const std::string& name);

/// Makes spdlog's default logger. Call once, before other threads start.
void setUpLogging(const LogOptions& options);

/// Writes a failure that ends the program: "PROGRAM: MESSAGE", or a JSON object once setUpLogging() chose JSON.
void reportFailure(const std::string& message);

}  // namespace spindrift::cli
