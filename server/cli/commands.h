// The program's commands, each with a file for its flags and its work, and what they share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <boost/json/fwd.hpp>

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

/// Writes a command's JSON to a file, or to standard output for "-"; does nothing for an empty name. kUnavailable when
/// the file cannot be written; the message names the option.
core::Result<void> writeJson(const std::string& file, const boost::json::value& value,
                             const std::string& option = "--json");
/// The same for a text.
core::Result<void> writeText(const std::string& file, const std::string& text, const std::string& option);

/// Writes the error's line to standard error (logging.h) and returns its exit code.
int fail(const core::Error& error);

/// Does the work of main(): `add` gives the parser its options or subcommands; the one that was parsed runs. Returns
/// the exit code (see ProgramCommand::run); errors are reported in the form of the log.
int runProgram(const std::string& name, const std::string& description,
               const std::function<std::vector<ProgramCommand>(CLI::App&)>& add, int argc, char** argv);

}  // namespace spindrift::cli
