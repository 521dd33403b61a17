// spindrift: the program. Parses the flags and runs the command.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>

#include "commands.h"

namespace {

constexpr int kUsageError = 2;

void setUpLogging(const std::string& level) {
  // Standard output is for results (--json -, the address); the log goes to standard error.
  auto logger = spdlog::stderr_color_mt("spindrift");
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(logger));
}

int run(int argc, char** argv) {
  using namespace spindrift::cli;
  CLI::App cli{
      "Spindrift: a headless water server. It simulates coupled particles and waves on a GPU and streams them to "
      "browsers."};
  cli.name("spindrift");
  cli.set_version_flag("--version", std::string(spindrift::core::nameAndVersion()));
  cli.require_subcommand(1);
  std::string log_level = "info";
  cli.add_option("--log-level", log_level, "Level of the log on standard error")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  cli.fallthrough();

  std::vector<ProgramCommand> commands;
  for (const auto add : {addServe, addReplay, addScript, addInfo, addCheck, addBench, addStudy})
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
  setUpLogging(log_level);
  for (const ProgramCommand& command : commands) {
    if (command.parser->parsed()) return command.run();
  }
  return kUsageError;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spindrift: unexpected: %s\n", error.what());
    return 1;
  }
}
