// A command line of `spindrift serve`, parsed without the program.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>

#include "logging.h"
#include "option_sources.h"
#include "serve_options.h"

namespace spindrift::test {

/// Options, parsers and what completing them returned. CLI11 keeps references into it, so it stays where it is.
struct CommandLine {
  cli::ServeOptions options;
  cli::LogOptions log;
  CLI::App program{"spindrift"};
  CLI::App* serve = nullptr;
  std::optional<cli::OptionSources> sources;
  std::string error;  ///< empty: no error

  /// Parses `spindrift serve ARGUMENTS`. Throws CLI::ParseError where the flags are wrong.
  explicit CommandLine(std::vector<std::string> arguments) {
    cli::addLogOptions(program, log);
    program.fallthrough();
    serve = program.add_subcommand("serve");
    cli::addServeOptions(*serve, options);
    std::ranges::reverse(arguments);  // CLI11 takes them from the back
    arguments.push_back("serve");
    program.parse(arguments);
    auto completed = cli::completeFrontOptions(program, *serve, options);
    if (completed) {
      sources = *std::move(completed);
    } else {
      error = completed.error().message;
    }
  }

  cli::OptionSource sourceOf(const std::string& field) const { return sources->at(field).source; }
};

/// Starts with no variable of an option set, and takes away those that a test sets.
class CommandLineTest : public testing::Test {
 protected:
  CommandLineTest() {
    CommandLine bare({});
    const cli::OptionSources options{bare.serve, &bare.program};
    for (const auto& entry : options.entries()) unset(cli::variableName(*entry.option));
    unset("SPINDRIFT_TOKENS");
    unset("SPINDRIFT_CONFIG");
  }
  ~CommandLineTest() override {
    for (const auto& [name, value] : before_)
      value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
  }
  void set(const std::string& name, const std::string& value) {
    keep(name);
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  void unset(const std::string& name) {
    keep(name);
    ::unsetenv(name.c_str());
  }

 private:
  void keep(const std::string& name) {
    const char* const value = std::getenv(name.c_str());
    before_.try_emplace(name, value == nullptr ? std::nullopt : std::optional<std::string>(value));
  }

  std::map<std::string, std::optional<std::string>> before_;
};

}  // namespace spindrift::test
