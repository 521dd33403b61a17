#include "option_sources.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace spindrift::cli {
namespace {

bool isFlag(const CLI::Option& option) {
  return option.get_expected_max() == 0;
}

/// Gives the option its values as if they were flags. kInvalidInput begins with `label`.
core::Result<void> give(CLI::Option& option, const std::vector<std::string>& values, const std::string& label) {
  try {
    option.add_result(values);
    option.run_callback();
    return {};
  } catch (const CLI::ConversionError&) {
    const std::string wanted = isFlag(option) ? "write true or false" : "see spindrift serve --help";
    return core::invalid(label + ": '" + CLI::detail::join(values, " ") + "' cannot be used; " + wanted);
  } catch (const CLI::ParseError& error) {
    std::string_view reason = error.what();
    const std::string prefix = option.get_name() + ": ";
    if (reason.starts_with(prefix)) reason.remove_prefix(prefix.size());
    return core::invalid(label + ": " + std::string(reason));
  }
}

/// Kubernetes gives every pod variables with the URLs of the Services: SPINDRIFT_PORT for one named spindrift.
bool isServiceLink(std::string_view text) {
  return text.starts_with("tcp://") || text.starts_with("udp://") || text.starts_with("sctp://");
}

/// Returns what the environment holds for the option; empty where the variable is unset or empty. ';' separates the
/// values of an option that may be repeated; spaces around each are removed.
std::vector<std::string> environmentValues(const CLI::Option& option) {
  const char* const text = std::getenv(variableName(option).c_str());
  if (text == nullptr || *text == '\0') return {};
  if (option.get_items_expected_max() <= 1) return {text};
  std::vector<std::string> values;
  for (std::string& value : CLI::detail::split(text, ';')) {
    CLI::detail::trim(value);
    if (!value.empty()) values.push_back(std::move(value));
  }
  return values;
}

}  // namespace

std::string fieldName(const CLI::Option& option) {
  std::string name = option.get_name();  // the first long name
  name.erase(0, name.find_first_not_of('-'));
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string variableName(const CLI::Option& option) {
  std::string name = "SPINDRIFT_" + fieldName(option);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

OptionSources::OptionSources(std::initializer_list<CLI::App*> parsers) {
  for (CLI::App* const parser : parsers) {
    for (CLI::Option* const option :
         parser->get_options([](CLI::Option* candidate) { return candidate->get_configurable(); })) {
      entries_.push_back(option->count() > 0 ? Entry{option, OptionSource::kFlag, "flag"}
                                             : Entry{option, OptionSource::kDefault, "default"});
    }
  }
}

core::Result<void> OptionSources::takeEnvironment() {
  for (Entry& entry : entries_) {
    if (entry.source != OptionSource::kDefault) continue;
    const std::vector<std::string> values = environmentValues(*entry.option);
    if (values.empty()) continue;
    const std::string variable = variableName(*entry.option);
    if (auto given = give(*entry.option, values, variable); !given) {
      if (!isServiceLink(values.front())) return given;
      return core::Error{
          core::ErrorCode::kInvalidInput,
          variable + ": '" + values.front() +
              "' was set by Kubernetes for a Service named spindrift: write enableServiceLinks: false in "
              "the pod's spec, or give the Service another name"};
    }
    entry.source = OptionSource::kEnvironment;
    entry.place = "environment: " + variable;
  }
  return {};
}

core::Result<void> OptionSources::takeFromFile(const std::string& field, const std::vector<std::string>& values,
                                               int line, const std::string& label) {
  Entry& entry = find(field);
  if (entry.source != OptionSource::kDefault) return {};
  if (auto given = give(*entry.option, values, label); !given) return given;
  entry.source = OptionSource::kFile;
  entry.place = "file, line " + std::to_string(line);
  return {};
}

core::Result<void> OptionSources::suggest(const std::string& field, const std::string& value,
                                          const std::string& place) {
  Entry& entry = find(field);
  if (entry.source != OptionSource::kDefault) return {};
  if (auto given = give(*entry.option, {value}, place); !given) return given;
  entry.place = place;
  return {};
}

void OptionSources::replaceByVariable(const std::string& field, const std::string& variable) {
  Entry& entry = find(field);
  entry.source = OptionSource::kEnvironment;
  entry.place = "environment: " + variable + " instead";
}

bool OptionSources::has(const std::string& field) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) { return fieldName(*entry.option) == field; });
}

const OptionSources::Entry& OptionSources::at(const std::string& field) const {
  const auto found = std::ranges::find(entries_, field, [](const Entry& entry) { return fieldName(*entry.option); });
  if (found == entries_.end()) throw std::logic_error("no option for the field " + field);
  return *found;
}

OptionSources::Entry& OptionSources::find(const std::string& field) {
  return entries_[static_cast<std::size_t>(&at(field) - entries_.data())];
}

}  // namespace spindrift::cli
