// A program of the command line: parses the flags and runs the command that they choose.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands.h"

namespace spindrift::cli {

/// Does the work of main(): `add` gives the parser its options or subcommands; the one that was parsed runs. Returns
/// the exit code (see ProgramCommand::run); errors are reported in the form of the log.
int runProgram(const std::string& name, const std::string& description,
               const std::function<std::vector<ProgramCommand>(CLI::App&)>& add, int argc, char** argv);

}  // namespace spindrift::cli
