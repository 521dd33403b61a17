// Where the values of a command's options come from: a flag, else the environment, else a configuration file, else the
// default. CLI11 parses the flags; its own order puts the file above the environment and its messages know neither
// variables nor lines, so the other sources are added here, through CLI11's options and with their checks (decision
// 123).
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <spindrift/core/result.h>

namespace spindrift::cli {

enum class OptionSource { kDefault, kFile, kEnvironment, kFlag };

/// "max_rooms" for --max-rooms: the first long name with '_' in place of '-'.
std::string fieldName(const CLI::Option& option);

/// "SPINDRIFT_MAX_ROOMS" for --max-rooms.
std::string variableName(const CLI::Option& option);

/// The options of one or several parsers, without those that are not configurable() (--help). The parsers outlive it.
class OptionSources {
 public:
  struct Entry {
    CLI::Option* option;
    OptionSource source;
    std::string place;  ///< for people: "flag", "environment: SPINDRIFT_PORT", "file, line 3", "default"
  };

  /// Call after the flags were parsed.
  explicit OptionSources(std::initializer_list<CLI::App*> parsers);

  /// Gives every option that has no flag the value of its variable. kInvalidInput names the variable.
  core::Result<void> takeEnvironment();

  /// Gives an option that still has its default these values from line `line` (from 1) of a file, checked as a flag's
  /// are; an option with a value keeps it. kInvalidInput begins with `label`.
  core::Result<void> takeFromFile(const std::string& field, const std::vector<std::string>& values, int line,
                                  const std::string& label);

  /// Gives an option that still has its default another one; `place` says why.
  core::Result<void> suggest(const std::string& field, const std::string& value, const std::string& place);

  /// The environment decides about this option by another variable than its own: a file cannot set it any more.
  void replaceByVariable(const std::string& field, const std::string& variable);

  /// Returns whether an option has this field: the file knows those of all commands.
  bool has(const std::string& field) const;
  /// The field must be one of an option here.
  const Entry& at(const std::string& field) const;
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  Entry& find(const std::string& field);

  std::vector<Entry> entries_;
};

}  // namespace spindrift::cli
