#include "config_file.h"

#include <cctype>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <spindrift/core/files.h>
#include <spindrift/core/text.h>
#include <spindrift/v1/serve_config.pb.h>

namespace spindrift::cli {
namespace {

using core::Error;
using google::protobuf::FieldDescriptor;
using google::protobuf::TextFormat;

/// Returns what to write for the field, with the bounds that its option has.
std::string wantedForm(const FieldDescriptor& field, const OptionSources& options) {
  const std::string type = options.at(field.name()).option->get_type_name();  // such as "UINT:INT in [0 - 65535]"
  const std::size_t range = type.find(" in [");
  const std::string bounds = range == std::string::npos ? "" : type.substr(range);
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return "write true or false";
    case FieldDescriptor::CPPTYPE_INT64:
      return "write a whole number" + bounds;
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return "write a number" + bounds;
    default:
      return "write text in quotes";
  }
}

/// Returns the part of `text` before a location, counted as Protobuf's tokenizer does: from 0, with tab stops at
/// multiples of 8.
std::string_view textBefore(std::string_view text, int line, int column) {
  std::size_t at = 0;
  for (int i = 0; i < line; ++i) {
    at = text.find('\n', at);
    if (at == std::string_view::npos) return text;
    ++at;
  }
  for (int reached = 0; reached < column && at < text.size(); ++at) reached += text[at] == '\t' ? 8 - reached % 8 : 1;
  return text.substr(0, at);
}

/// Returns the field whose name, perhaps with a colon, ends `text`; nullptr if it ends with no field.
const FieldDescriptor* lastField(std::string_view text) {
  const auto removeSpace = [&text] {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  };
  removeSpace();
  if (text.ends_with(':')) text.remove_suffix(1);
  removeSpace();
  const auto isOfName = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::size_t begin = text.size();
  while (begin > 0 && isOfName(text[begin - 1])) --begin;
  const std::size_t line = text.rfind('\n') + 1;                       // 0 without a line break
  if (text.find('#', line) != std::string_view::npos) return nullptr;  // a word of a comment
  return v1::ServeConfig::descriptor()->FindFieldByName(std::string(text.substr(begin)));
}

/// Keeps the first error of the parser, in the words of this program.
class FirstError final : public google::protobuf::io::ErrorCollector {
 public:
  FirstError(std::string_view text, const std::string& label, const OptionSources& options)
      : text_(text), label_(label), options_(options) {}

  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    constexpr std::size_t kMessageMaxBytes = 1000;
    if (message_.empty()) {
      message_ = fmt::format("{}:{}:{}: ", label_, line + 1, column + 1) +
                 core::quoteText(say(line, column, message), kMessageMaxBytes);
    }
  }
  const std::string& message() const { return message_; }

 private:
  std::string say(int line, int column, std::string_view message) const {
    constexpr std::string_view kUnknown = "has no field named \"";
    if (const auto at = message.find(kUnknown); at != std::string_view::npos) {
      const std::string_view rest = message.substr(at + kUnknown.size());
      return fmt::format("there is no field '{}'; spindrift serve --print-config lists the fields",
                         rest.substr(0, rest.find('"')));
    }
    if (message.ends_with('.')) message.remove_suffix(1);
    const FieldDescriptor* const field = lastField(textBefore(text_, line, column));
    if (field == nullptr) return fmt::format("{}; write lines of FIELD: VALUE", message);
    if (message.find("specified multiple times") != std::string_view::npos)
      return fmt::format("{}: it is given twice; remove one", field->name());
    return fmt::format("{}: {}; {}", field->name(), message, wantedForm(*field, options_));
  }

  std::string_view text_;
  const std::string& label_;
  const OptionSources& options_;
  std::string message_;
};

/// Returns the values of a field as a command line would hold them.
std::vector<std::string> valuesOf(const v1::ServeConfig& config, const FieldDescriptor& field) {
  const auto& reflection = *config.GetReflection();
  if (field.is_repeated()) {
    std::vector<std::string> values;
    for (int i = 0; i < reflection.FieldSize(config, &field); ++i)
      values.push_back(reflection.GetRepeatedString(config, &field, i));
    return values;
  }
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return {reflection.GetBool(config, &field) ? "true" : "false"};
    case FieldDescriptor::CPPTYPE_INT64:
      return {std::to_string(reflection.GetInt64(config, &field))};
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return {fmt::format("{}", reflection.GetDouble(config, &field))};  // the shortest text with the same value
    default:
      return {reflection.GetString(config, &field)};
  }
}

/// Sets the field to what the option has, default included; leaves it out where the option has no value.
void setField(v1::ServeConfig& config, const FieldDescriptor& field, const CLI::Option& option) {
  const auto& reflection = *config.GetReflection();
  const bool has_value = option.count() > 0 || !option.get_default_str().empty();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
    reflection.SetBool(&config, &field, has_value && option.as<bool>());
  } else if (!has_value) {
    return;
  } else if (field.is_repeated()) {
    for (const auto& value : option.as<std::vector<std::string>>()) reflection.AddString(&config, &field, value);
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_INT64) {
    reflection.SetInt64(&config, &field, option.as<std::int64_t>());
  } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
    reflection.SetDouble(&config, &field, option.as<double>());
  } else {
    reflection.SetString(&config, &field, option.as<std::string>());
  }
}

}  // namespace

core::Result<void> takeConfigFile(const std::string& file, OptionSources& options) {
  const auto text =
      core::readText(file, kConfigFileMaxBytes, "a configuration file", "a configuration is a small text");
  if (!text) return Error{text.error().code, "--config " + file + ": " + text.error().message};
  return takeConfigText(*text, file, options);
}

core::Result<void> takeConfigText(std::string_view text, const std::string& label, OptionSources& options) {
  v1::ServeConfig config;
  FirstError errors(text, label, options);
  TextFormat::ParseInfoTree places;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.WriteLocationsTo(&places);
  if (!parser.ParseFromString(std::string(text), &config)) return core::invalid(errors.message());

  std::vector<const FieldDescriptor*> fields;
  config.GetReflection()->ListFields(config, &fields);
  for (const FieldDescriptor* const field : fields) {
    const TextFormat::ParseLocation place = places.GetLocation(field, field->is_repeated() ? 0 : -1);
    const std::string where = fmt::format("{}:{}:{}: {}", label, place.line + 1, place.column + 1, field->name());
    if (!options.has(field->name())) return core::invalid(where + ": this command has no such option; leave it out");
    const std::vector<std::string> values = valuesOf(config, *field);
    for (const std::string& value : values) {
      // Neither flags nor variables can hold one, and a path would end there.
      if (value.find('\0') != std::string::npos)
        return core::invalid(where + ": the text holds a zero byte (\\000); remove it");
    }
    if (auto taken = options.takeFromFile(field->name(), values, place.line + 1, where); !taken) return taken;
  }
  return {};
}

std::string configText(const OptionSources& options) {
  v1::ServeConfig config;
  std::string text = "# The options of spindrift, and where each value comes from. Read again by --config FILE.\n";
  const auto& type = *v1::ServeConfig::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (!options.has(field.name())) continue;
    const OptionSources::Entry& entry = options.at(field.name());
    setField(config, field, *entry.option);
    const auto& reflection = *config.GetReflection();
    const int count = field.is_repeated() ? reflection.FieldSize(config, &field) : reflection.HasField(config, &field);
    for (int index = 0; index < count; ++index) {
      std::string value;
      TextFormat::PrintFieldValueToString(config, &field, field.is_repeated() ? index : -1, &value);
      text += fmt::format("{}: {}  # {}\n", field.name(), value, entry.place);
    }
    if (count == 0) text += fmt::format("# {}: not set  # {}\n", field.name(), entry.place);
  }
  return text;
}

}  // namespace spindrift::cli
