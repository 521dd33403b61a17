#include "program.h"

#include <cstdio>
#include <exception>

#include <spindrift/core/version.h>

#include "logging.h"
#include "option_sources.h"

namespace spindrift::cli {
namespace {

constexpr int kUsageError = 2;

/// Gives the options that have no flag the values of the environment, and those that the command takes from a file.
core::Result<void> completeOptions(CLI::App& program, const ProgramCommand& command) {
  if (command.complete) return command.complete();
  return OptionSources{&program}.takeEnvironment();
}

int parseAndRun(CLI::App& program, const std::vector<ProgramCommand>& commands, const LogOptions& log, int argc,
                char** argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    // CLI11 reports a missing subcommand before it reports unknown words in its place.
    const std::vector<std::string> unknown =
        program.get_subcommands().empty() ? program.remaining() : std::vector<std::string>{};
    const std::string what = unknown.empty() ? error.what() : "there is no command or flag '" + unknown.front() + "'";
    std::fprintf(stderr, "%s: %s; run '%s --help'\n", program.get_name().c_str(), what.c_str(),
                 program.get_name().c_str());
    return kUsageError;
  }
  for (const ProgramCommand& command : commands) {
    if (!command.parser->parsed()) continue;
    const auto completed = completeOptions(program, command);
    setUpLogging(log);  // also before a failure is reported, which has the form of the log
    return completed ? command.run() : fail(completed.error());
  }
  return kUsageError;
}

}  // namespace

int runProgram(const std::string& name, const std::string& description,
               const std::function<std::vector<ProgramCommand>(CLI::App&)>& add, int argc, char** argv) {
  try {
    nameProgram(name);
    CLI::App program{description};
    program.name(name);
    program.set_version_flag("--version", std::string(core::nameAndVersion()));
    LogOptions log;
    addLogOptions(program, log);
    program.fallthrough();
    const std::vector<ProgramCommand> commands = add(program);
    return parseAndRun(program, commands, log, argc, argv);
  } catch (const std::exception& error) {
    reportFailure(std::string("unexpected: ") + error.what());
    return 1;
  }
}

}  // namespace spindrift::cli
