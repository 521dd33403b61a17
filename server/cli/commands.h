// The program's commands. Each has a file with its flags and its work.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include <spindrift/core/result.h>

namespace spindrift::cli {

struct ProgramCommand {
  CLI::App* parser = nullptr;
  /// Returns the exit code: 0 success, 1 a check failed, 2 bad usage or input, 3 no usable device. Call after parsing.
  std::function<int()> run;
  /// Gives options without a flag the values of other sources. Call before `run` and before the log is set up. Empty:
  /// the command has flags only, and the program's own options also have environment variables.
  std::function<core::Result<void>()> complete = {};
};

// Add a command with its flags to the program.
ProgramCommand addServe(CLI::App& program);
ProgramCommand addEdge(CLI::App& program);
ProgramCommand addReplay(CLI::App& program);
ProgramCommand addScript(CLI::App& program);
ProgramCommand addInfo(CLI::App& program);
ProgramCommand addCheck(CLI::App& program);

// Flags that several commands have.
void addDevice(CLI::App& command, std::string& device);
void addFidelity(CLI::App& command, std::string& fidelity);
void addJson(CLI::App& command, std::string& file);

/// Writes the error's line to standard error (logging.h) and returns its exit code.
int fail(const core::Error& error);

}  // namespace spindrift::cli
