#include "commands.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>

#include <boost/json/serialize.hpp>

#include <spindrift/core/version.h>

#include "forms.h"
#include "logging.h"
#include "option_sources.h"

namespace spindrift::cli {
namespace {

constexpr int kUsageError = 2;

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
    const auto completed = command.complete ? command.complete() : OptionSources{&program}.takeEnvironment();
    setUpLogging(log);  // also before a failure is reported, which has the form of the log
    return completed ? command.run() : fail(completed.error());
  }
  return kUsageError;
}

}  // namespace

void addDevice(CLI::App& command, std::string& device) {
  command.add_option("--device", device, "auto, software, or a device from `info`: its number, DRM file or UUID")
      ->check(isText())
      ->capture_default_str();
}

void addFidelity(CLI::App& command, std::string& fidelity) {
  command.add_option("--fidelity", fidelity, "Fidelity of all scenes, in place of the one in their files")
      ->check(CLI::IsMember({"draft", "balanced", "fine", "reference"}));
}

void addJson(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "Write JSON to this file, - = standard output")->check(isOutputFile());
}

core::Result<void> writeJson(const std::string& file, const boost::json::value& value, const std::string& option) {
  return file.empty() ? core::Result<void>() : writeText(file, boost::json::serialize(value) + "\n", option);
}

core::Result<void> writeText(const std::string& file, const std::string& text, const std::string& option) {
  if (file == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return {};
  }
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    return core::Error{core::ErrorCode::kUnavailable,
                       option + " '" + file + "': cannot be written: " + std::strerror(errno)};
  return {};
}

int fail(const core::Error& error) {
  reportFailure(error.message);
  return core::exitCode(error.code);
}

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
