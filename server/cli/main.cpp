// spindrift: the program. Parses the flags and runs the command.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <spindrift/core/version.h>

#include "commands.h"
#include "logging.h"
#include "option_sources.h"

namespace {

constexpr int kUsageError = 2;

/// Gives the options that have no flag the values of the environment, and those that the command takes from a file.
spindrift::core::Result<void> completeOptions(CLI::App& program, const spindrift::cli::ProgramCommand& command) {
  if (command.complete) return command.complete();
  return spindrift::cli::OptionSources{&program}.takeEnvironment();
}

int run(int argc, char** argv) {
  using namespace spindrift::cli;
  CLI::App cli{
      "Spindrift: a headless water server. It simulates coupled particles and waves on a GPU and streams them to "
      "browsers."};
  cli.name("spindrift");
  cli.set_version_flag("--version", std::string(spindrift::core::nameAndVersion()));
  cli.require_subcommand(1);
  LogOptions log;
  addLogOptions(cli, log);
  cli.fallthrough();

  std::vector<ProgramCommand> commands;
  for (const auto add : {addServe, addEdge, addReplay, addScript, addInfo, addCheck, addBench, addStudy})
    commands.push_back(add(cli));

  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);  // --help, --version
    // CLI11 reports a missing subcommand before it reports unknown words in its place.
    const std::vector<std::string> unknown =
        cli.get_subcommands().empty() ? cli.remaining() : std::vector<std::string>{};
    const std::string what = unknown.empty() ? error.what() : "there is no command or flag '" + unknown.front() + "'";
    std::fprintf(stderr, "spindrift: %s; run 'spindrift --help'\n", what.c_str());
    return kUsageError;
  }
  for (const ProgramCommand& command : commands) {
    if (!command.parser->parsed()) continue;
    const auto completed = completeOptions(cli, command);
    setUpLogging(log);  // also before a failure is reported, which has the form of the log
    return completed ? command.run() : fail(completed.error());
  }
  return kUsageError;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    spindrift::cli::reportFailure(std::string("unexpected: ") + error.what());
    return 1;
  }
}
